#include "perception/prepared_part.hpp"

#include "core/byte_stream.hpp"
#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "core/yaml.hpp"
#include "perception/covisibility.hpp"
#include "perception/edge_points.hpp"
#include "perception/preprocess.hpp"
#include "perception/score_calibration.hpp"

namespace binpick {
namespace {

/// Raise it whenever other code gives other bytes for the same inputs: when the layout of write_prepared changes, or
/// what any of these makes: sample_surface, hidden_points, model_cloud, voxel_grid, edge_points, pair_kernel,
/// pair_table, parallel_rays, covisibility, surface_model, self_overlap, zbuffer, symmetry (sampled_group). When in
/// doubt, raise it: that costs every part a tenth of a second, once.
constexpr std::uint32_t kPreparedVersion = 1;

/// All that decides what is computed, and nothing else: compute() sees no more than this, and the key covers it.
struct Inputs {
  const TriangleMesh& mesh_P;
  const Symmetry& symmetry;
  double diameter;
  ModelCloudConfig model;
  double voxel;  // m
  double reach;  // m, of the surface's grid
  PairQuantiser quantiser;

  Inputs(const Part& part, const PpfSettings& settings)
      : mesh_P(part.mesh_P),
        symmetry(part.symmetry),
        diameter(part.diameter),
        model(settings.model),
        voxel(settings.preprocess.voxel * part.diameter),
        reach(1.2 * settings.icp.gate * part.diameter),
        quantiser(settings.voting.quantiser(part.diameter)) {}
};

void compute(const Inputs& in, PreparedPart& p) {
  PointCloud points_P, edges_P;
  parallel_for(2, 2, [&](std::size_t k) {
    if (k == 0) p.surface = SurfaceModel(in.mesh_P, 0.02 * in.diameter, in.reach);
    if (k == 1) {
      const PointCloud visible_P = model_cloud(in.mesh_P, in.diameter, in.model);
      points_P = voxel_grid(visible_P, in.voxel);
      edges_P = model_edges(in.mesh_P, visible_P, in.voxel);
      p.overlaps = self_overlaps(in.mesh_P, in.symmetry, in.diameter);
    }
  });
  std::vector<SurfaceModel::ViewMask> points_seen, edges_seen;
  if (in.model.covisible) {
    points_seen = views_of(points_P, p.surface, Facing::kAlike);
    edges_seen = views_of(edges_P, p.surface, Facing::kAny);
  }
  p.table = PairTable(points_P, in.symmetry, in.quantiser, 0.8 * in.voxel, points_seen);
  p.edge_table = PairTable(edges_P, in.symmetry, in.quantiser, 0.8 * in.voxel, edges_seen);
}

/// What costs nothing.
PreparedPart beginning_of(const Part& part) {
  PreparedPart p;
  p.diameter = part.diameter;
  p.symmetry = part.symmetry;
  const Eigen::AlignedBox3d box = bounding_box(part.mesh_P);
  p.center_P = box.center();
  p.thinnest = box.sizes().minCoeff();
  p.twists = symmetry_twists(part.symmetry);
  return p;
}

void add_symmetry(const Symmetry& symmetry, ByteWriter& out) {
  out.add(static_cast<std::uint64_t>(symmetry.finite.size()));
  for (const Pose& S : symmetry.finite) out.add(S.matrix());
  out.add(static_cast<std::uint32_t>(symmetry.axis.has_value()));
  if (symmetry.axis) out.add(symmetry.axis->direction_P).add(symmetry.axis->point_P);
  out.add(static_cast<std::uint32_t>(symmetry.center_P.has_value()));
  if (symmetry.center_P) out.add(*symmetry.center_P);
}

}  // namespace

CacheKey prepared_part_key(const Part& part, const PpfSettings& settings) {
  Inputs in(part, settings);
  ByteWriter all;
  all.add(in.mesh_P.vertices).add(in.mesh_P.triangles);
  add_symmetry(in.symmetry, all);
  all.add(in.diameter).add(in.voxel).add(in.reach);
  all.add(in.quantiser.distance_step).add(in.quantiser.angle_step);
  all.add(in.quantiser.distance_bins).add(in.quantiser.angle_bins);
  all.add(std::string_view(write_yaml([&](ConfigVisitor& v) { in.model.visit(v); })));
  return {"prepared_part", kPreparedVersion, content_hash(all.bytes())};
}

void write_prepared(const PreparedPart& prepared, ByteWriter& out) {
  prepared.table.write(out);
  prepared.edge_table.write(out);
  prepared.surface.write(out);
  out.add(static_cast<std::uint64_t>(prepared.overlaps.size()));
  for (const SelfOverlap& overlap : prepared.overlaps) out.add(overlap.T.matrix()).add(overlap.alike);
}

bool read_prepared(ByteReader& in, const Part& part, const PpfSettings& settings, PreparedPart& prepared) {
  prepared = beginning_of(part);
  const PairQuantiser quantiser = settings.voting.quantiser(part.diameter);
  prepared.table = PairTable(in, quantiser);
  prepared.edge_table = PairTable(in, quantiser);
  prepared.surface = SurfaceModel(in);
  prepared.overlaps.resize(static_cast<std::size_t>(in.length(17 * sizeof(double))));
  for (SelfOverlap& overlap : prepared.overlaps) {
    in.get(overlap.T.matrix()).get(overlap.alike);
    if (!is_rigid(overlap.T)) in.fail();
  }
  return in.done();
}

PreparedPart prepare_part(const Part& part, const PpfSettings& settings) {
  PreparedPart p = beginning_of(part);
  compute(Inputs(part, settings), p);
  return p;
}

PreparedPart prepare_part(const Part& part, const PpfSettings& settings, const DiskCache& cache) {
  if (!cache.in_use()) return prepare_part(part, settings);
  const CacheKey key = prepared_part_key(part, settings);
  if (const auto bytes = cache.load(key)) {
    PreparedPart kept;
    ByteReader in(*bytes);
    if (read_prepared(in, part, settings, kept)) return kept;
  }
  PreparedPart computed = prepare_part(part, settings);
  ByteWriter out;
  write_prepared(computed, out);
  cache.store(key, out.bytes());
  return computed;
}

}  // namespace binpick
