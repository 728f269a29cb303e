// A prepared part from the disk is the prepared part that would be computed, or it is not taken.
#include "perception/prepared_part.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "core/byte_stream.hpp"
#include "core/random.hpp"
#include "perception/ppf_pipeline.hpp"
#include "tests/core/temp_folder.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

std::string bytes_of(const PreparedPart& prepared) {
  ByteWriter out;
  write_prepared(prepared, out);
  return out.bytes();
}

/// What search, check and refinement see of a table and of a surface.
void expect_same_table(const PairTable& a, const PairTable& b) {
  EXPECT_EQ(a.first(), b.first());
  EXPECT_EQ(a.most_of_one(), b.most_of_one());
  EXPECT_EQ(a.quantiser().cells(), b.quantiser().cells());
  ASSERT_EQ(a.entry_count(), b.entry_count());
  EXPECT_EQ(std::memcmp(a.all_entries().data(), b.all_entries().data(), a.entry_count() * sizeof(PairEntry)), 0);
  ASSERT_EQ(a.references().size(), b.references().size());
  for (std::size_t i = 0; i < a.references().size(); ++i) {
    EXPECT_EQ(a.references()[i].point, b.references()[i].point);
    EXPECT_EQ(a.references()[i].normal, b.references()[i].normal);
  }
}

void expect_same_surface(const SurfaceModel& a, const SurfaceModel& b) {
  EXPECT_EQ(a.points(), b.points());
  EXPECT_EQ(a.normals(), b.normals());
  EXPECT_EQ(a.radius(), b.radius());
  EXPECT_EQ(a.shell().vertices, b.shell().vertices);
  EXPECT_EQ(a.shell().triangles, b.shell().triangles);
  const Eigen::Vector3d eye(0.3, -0.2, 0.5);
  EXPECT_EQ(a.shell_facing(eye).triangles, b.shell_facing(eye).triangles);
  for (int v = 0; v < SurfaceModel::kViews; ++v) {
    EXPECT_EQ(a.seen_from(v), b.seen_from(v));
    const ModelPointsView p = a.seen_points(v, 100), q = b.seen_points(v, 100);
    ASSERT_EQ(p.count, q.count);
    EXPECT_EQ(std::memcmp(p.x, q.x, static_cast<std::size_t>(p.count) * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(p.nz, q.nz, static_cast<std::size_t>(p.count) * sizeof(float)), 0);
  }
  Rng rng = Seed{5}.rng();
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f at = (0.08 * rng.unit_vector() * rng.uniform()).cast<float>();
    EXPECT_EQ(a.nearest(at), b.nearest(at));
    EXPECT_EQ(a.view_of(at), b.view_of(at));
  }
}

TEST(PreparedPart, FromTheDiskIsWhatWouldBeComputed) {
  const TempFolder folder;
  const DiskCache cache(folder.at("cache"));
  PpfSettings settings;
  for (const Part& part : {ring_part(), bracket_part()}) {
    const PreparedPart computed = prepare_part(part, settings, cache);
    ASSERT_TRUE(cache.load(prepared_part_key(part, settings)));
    const PreparedPart kept = prepare_part(part, settings, cache);
    EXPECT_EQ(bytes_of(kept), bytes_of(prepare_part(part, settings)));
    expect_same_table(kept.table, computed.table);
    expect_same_table(kept.edge_table, computed.edge_table);
    expect_same_surface(kept.surface, computed.surface);
    ASSERT_EQ(kept.overlaps.size(), computed.overlaps.size());
    EXPECT_EQ(kept.center_P, computed.center_P);
    EXPECT_EQ(kept.thinnest, computed.thinnest);
    EXPECT_EQ(kept.diameter, computed.diameter);
    EXPECT_EQ(kept.twists, computed.twists);
    EXPECT_EQ(kept.symmetry.finite.size(), part.symmetry.finite.size());
  }
}

TEST(PreparedPart, FromTheDiskGivesTheSameEstimates) {
  const TempFolder folder;
  const DiskCache cache(folder.at("cache"));
  const Part part = bracket_part();
  PpfEstimator computed{PpfSettings{}}, kept{PpfSettings{}};
  computed.prepare_with(std::span(&part, 1), cache);
  kept.prepare_with(std::span(&part, 1), cache);
  const HeapScene scene = make_scene(part, HeapOptions(), Seed{71}, camera_above(0.6));
  const auto a = computed.estimate(scene.view, Seed{1}).estimates, b = kept.estimate(scene.view, Seed{1}).estimates;
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].X_CP.matrix(), b[i].X_CP.matrix());
    EXPECT_EQ(a[i].score, b[i].score);
    EXPECT_EQ(a[i].covariance, b[i].covariance);
  }
}

TEST(PreparedPart, TheEstimatorTakesWhatItsFolderHolds) {
  const TempFolder folder;
  const DiskCache cache(folder.at("cache"));
  const Part part = bracket_part();
  PreparedPart marked = prepare_part(part, PpfSettings{});
  ASSERT_GT(marked.overlaps.size(), 1u);
  marked.overlaps.resize(1);
  ASSERT_TRUE(cache.store(prepared_part_key(part, PpfSettings{}), bytes_of(marked)));
  PpfEstimator estimator{PpfSettings{}};
  estimator.prepare_with(std::span(&part, 1), cache);
  EXPECT_EQ(estimator.prepared()[0].overlaps.size(), 1u);
  estimator.prepare_with(std::span(&part, 1), DiskCache(""));
  EXPECT_GT(estimator.prepared()[0].overlaps.size(), 1u);
}

TEST(PreparedPart, TheKeyIsOfEverythingThatDecides) {
  const Part part = bracket_part();
  const PpfSettings settings;
  const auto key = [](const Part& p, const PpfSettings& s) { return prepared_part_key(p, s).content.hex(); };
  const std::string same = key(part, settings);
  const auto with = [&](auto change) {
    PpfSettings changed;
    change(changed);
    return key(part, changed);
  };
  EXPECT_NE(with([](PpfSettings& s) { s.preprocess.voxel *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.model.spacing *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.model.view_distance *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.model.radius_factor *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.model.covisible = !s.model.covisible; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.icp.gate *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.voting.angle_step *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.voting.relative_step *= 1.1; }), same);
  EXPECT_NE(with([](PpfSettings& s) { s.voting.pair_radius *= 0.9; }), same);
  EXPECT_EQ(with([](PpfSettings& s) { s.search.clusters = 17; }), same);

  Part other = part;
  other.name = "another name";
  EXPECT_EQ(key(other, settings), same);
  other.mesh_P.vertices[3].z() += 1e-9;
  EXPECT_NE(key(other, settings), same);
  other = part;
  std::swap(other.mesh_P.triangles[0], other.mesh_P.triangles[1]);
  EXPECT_NE(key(other, settings), same);
  other = part;
  other.symmetry.axis = Symmetry::Axis{};
  const std::string turned = key(other, settings);
  EXPECT_NE(turned, same);
  other.symmetry.axis->point_P.x() = 1e-3;
  EXPECT_NE(key(other, settings), turned);
}

// Bytes with a right checksum that no write_prepared made: they are refused, or whatever is looked up in them lies in
// them.
TEST(PreparedPart, AnyBytesAreRefusedOrSafe) {
  const Part part = part_from("ring", ring_mesh(0.035, 0.05, 0.016, 12), {});
  PpfSettings settings;
  settings.preprocess.voxel = 0.15;
  settings.voting.relative_step = 0.2;
  settings.icp.gate = 0.02;
  const std::string whole = bytes_of(prepare_part(part, settings));
  const auto taken = [&](const std::string& bytes) {
    PreparedPart prepared;
    ByteReader in(bytes);
    if (!read_prepared(in, part, settings, prepared)) return false;
    for (const PairTable* table : {&prepared.table, &prepared.edge_table})
      for (int cell = 0; cell < table->quantiser().cells(); ++cell)
        for (const PairEntry& entry : table->entries(cell)) EXPECT_LT(entry.reference, table->references().size());
    const SurfaceModel& surface = prepared.surface;
    Rng rng = Seed{6}.rng();
    for (int i = 0; i < 100; ++i)
      EXPECT_LT(surface.nearest((0.08 * rng.unit_vector() * rng.uniform()).cast<float>()),
                static_cast<int>(surface.points().size()));
    return surface.shell_facing({0, 0, 1}).triangles.size() <= surface.shell().triangles.size();
  };
  ASSERT_TRUE(taken(whole));
  Rng rng = Seed{7}.rng();
  int refused = 0;
  constexpr int kRounds = 300;
  for (int round = 0; round < kRounds; ++round) {
    EXPECT_FALSE(taken(whole.substr(0, static_cast<std::size_t>(rng.below(whole.size())))));
    std::string bytes = whole;
    for (int k = 0; k < 3; ++k) bytes[rng.below(bytes.size())] = static_cast<char>(rng.below(256));
    refused += !taken(bytes);
  }
  EXPECT_GT(refused, 0);
  EXPECT_FALSE(taken(whole + '\0'));
  settings.voting.relative_step = 0.1;  // another table's cells
  EXPECT_FALSE(taken(whole));
}

}  // namespace
}  // namespace binpick
