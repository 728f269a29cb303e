#include "trials/cell_world.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "sim/bin.hpp"

namespace binpick {
namespace {

constexpr Material kMetal{0.6, 0, 0.3}, kDark{0.25, 0, 0.3}, kGrey{0.4, 0, 0.3};
constexpr double kProbeBack = 0.010;         // m: how far behind the lip a probe ray starts
constexpr double kProbeRange = 0.035;        // m
constexpr std::size_t kFirstMovingLink = 2;  // the base and the first link stand on the table

std::shared_ptr<const TriangleMesh> mesh_of_all(std::span<const Primitive> shapes) {
  TriangleMesh mesh;
  for (const Primitive& shape : shapes) append(mesh, mesh_of(shape));
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Lip and plunger rod for the eye: the rod reaches into the holder at full stroke.
std::shared_ptr<const TriangleMesh> lip_mesh(const CupSpec& cup) {
  const auto at = [](double z) { return Pose(Eigen::Translation3d(0, 0, z)); };
  const double lip = 0.006, rod = cup.stroke + 0.004;
  const std::vector<Primitive> shapes = {Primitive::cylinder(cup.radius, lip, at(-lip / 2)),
                                         Primitive::cylinder(0.4 * cup.radius, rod, at(-lip - rod / 2))};
  return mesh_of_all(shapes);
}

}  // namespace

CellWorld::CellWorld(const Cell& cell, const PhysicsConfig& physics, std::span<const Part> parts)
    : cell_(&cell), parts_(parts), world_(physics), q_(cell.q_look) {
  add_fixed_bodies();
  add_arm();
  for (const Part& part : parts) {
    part_meshes_.push_back(std::make_shared<const TriangleMesh>(part.mesh_P));
    part_queries_.emplace_back(part.mesh_P);
  }
}

void CellWorld::add_fixed_bodies() {
  const SurfaceMaterial material{cell_->bin.friction, cell_->bin.restitution};
  bin_body = add_bin(world_, cell_->bin, cell_->X_WB);
  table_body = world_.add_fixed(cell_->table_W(), Pose::Identity(), material);
  tray_body = world_.add_fixed(cell_->tray_W(), Pose::Identity(), material);
  thin_bin_body_ = add_drawn_bin(world_, cell_->bin, cell_->X_WB);
  world_.set_present(thin_bin_body_, false);
  bin_mesh_ = std::make_shared<const TriangleMesh>(drawn_bin(cell_->bin));
  table_mesh_ = mesh_of_all(cell_->table_W());
  tray_mesh_ = mesh_of_all(cell_->tray_W());
}

void CellWorld::add_arm() {
  const SurfaceMaterial metal{0.3, 0.0};
  const std::vector<Pose> link_poses = cell_->arm->link_poses(q_);
  for (std::size_t l = 0; l < link_poses.size(); ++l) {
    const std::vector<Primitive>& shapes = cell_->arm->link_shapes()[l];
    link_meshes_.push_back(mesh_of_all(shapes));
    link_bodies.push_back(shapes.empty() ? -1 : world_.add_moved(shapes, cell_->X_WR * link_poses[l], metal));
    if (!shapes.empty()) world_.set_present(link_bodies.back(), false);
  }
  const std::vector<Primitive> tool = cell_->gripper->body_G();
  tool_mesh_ = mesh_of_all(tool);
  std::vector<Primitive> solid = tool;  // what the flange carries, the camera too
  for (Primitive shape : cell_->camera_body_F()) {
    shape.X_OS = cell_->gripper->X_FG().inverse() * shape.X_OS;
    solid.push_back(shape);
  }
  tool_body = world_.add_moved(solid, cell_->tip_pose(q_), metal);
  world_.set_present(tool_body, false);
  camera_mesh_ = mesh_of_all(cell_->camera_body_F());
  for (const CupSpec& cup : cell_->gripper->cups()) lip_meshes_.push_back(lip_mesh(cup));
}

void CellWorld::set_heap(const DropResult& drop) {
  heap_ = drop;
  world_.set_present(tool_body, true);
  for (const BodyId link : link_bodies)
    if (link >= 0) world_.set_present(link, true);
  if (!hold_) hold_ = std::make_unique<CupHold>(world_, tool_body, cell_->gripper->cups(), hold_config_);
  jump_to(cell_->q_look);
}

void CellWorld::set_hold_config(const HoldConfig& config) {
  hold_config_ = config;
  if (hold_) hold_->set_config(config);
}

void CellWorld::set_joints(const Vector6d& q) {
  q_ = q;
  const std::vector<Pose> link_poses = cell_->arm->link_poses(q);
  for (std::size_t l = 0; l < link_poses.size(); ++l)
    if (link_bodies[l] >= 0) world_.move_to(link_bodies[l], cell_->X_WR * link_poses[l]);
  world_.move_to(tool_body, cell_->tip_pose(q));
}

void CellWorld::jump_to(const Vector6d& q) {
  q_ = q;
  const std::vector<Pose> link_poses = cell_->arm->link_poses(q);
  for (std::size_t l = 0; l < link_poses.size(); ++l)
    if (link_bodies[l] >= 0) world_.teleport(link_bodies[l], cell_->X_WR * link_poses[l]);
  world_.teleport(tool_body, cell_->tip_pose(q));
  if (hold_) hold_->reset_lips();
}

RenderScene CellWorld::render_scene() const {
  RenderScene scene;
  for (std::size_t i = 0; i < heap_.bodies.size(); ++i)
    if (world_.present(heap_.bodies[i]))
      scene.items.push_back(
          {part_meshes_[heap_.parts[i]], part_pose(i), static_cast<std::int32_t>(i), part_of(i).surface});
  add_items_of_cell(scene);
  return scene;
}

void CellWorld::add_items_of_cell(RenderScene& scene) const {
  scene.items.push_back({bin_mesh_, cell_->X_WB, kIdBin, kGrey});
  scene.items.push_back({table_mesh_, Pose::Identity(), kIdTable, kDark});
  scene.items.push_back({tray_mesh_, Pose::Identity(), kIdTray, kGrey});
  if (!hold_) return;  // the arm is not there yet
  for (std::size_t l = 0; l < link_bodies.size(); ++l)
    if (link_bodies[l] >= 0) scene.items.push_back({link_meshes_[l], world_.pose(link_bodies[l]), kIdArm, kMetal});
  const Pose X_WG = world_.pose(tool_body);
  scene.items.push_back({tool_mesh_, X_WG, kIdTool, kMetal});
  if (!camera_mesh_->empty())
    scene.items.push_back({camera_mesh_, X_WG * cell_->gripper->X_FG().inverse(), kIdArm, kDark});
  for (std::size_t c = 0; c < lip_meshes_.size(); ++c)
    scene.items.push_back({lip_meshes_[c], hold_->X_WU(c), kIdTool, kDark});
}

Eigen::Vector3d CellWorld::box_center(std::size_t heap_index) const {
  return part_pose(heap_index) * part_of(heap_index).box_center_P;
}

std::optional<std::size_t> CellWorld::heap_index_of(BodyId body) const {
  const auto found = std::find(heap_.bodies.begin(), heap_.bodies.end(), body);
  if (found == heap_.bodies.end()) return std::nullopt;
  return static_cast<std::size_t>(found - heap_.bodies.begin());
}

bool CellWorld::in_bin(std::size_t heap_index) const {
  const Eigen::Vector3d centre_W = part_pose(heap_index) * part_of(heap_index).mass.center_P;
  return inside_bin(cell_->bin, cell_->X_WB, centre_W, part_of(heap_index).diameter);
}

bool CellWorld::in_tray(std::size_t heap_index) const {
  BinSpec tray;
  tray.inner_size = cell_->tray.inner_size;
  return inside_bin(tray, cell_->tray.X_WT, box_center(heap_index), part_of(heap_index).diameter);
}

SurfaceSample CellWorld::first_hit(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                                   double range) const {
  SurfaceSample sample;
  double nearest = range;
  for (std::size_t i = 0; i < heap_.bodies.size(); ++i) {
    const BodyId body = heap_.bodies[i];
    const double reach = world_.bounding_radius(body) + range;
    if (!world_.present(body) || (world_.mass_center(body) - origin_W).norm() > reach) continue;
    const Pose X_WP = part_pose(i), X_PW = X_WP.inverse();
    const auto hit = part_queries_[heap_.parts[i]].ray(X_PW * origin_W, X_PW.linear() * direction_W, nearest);
    if (!hit || hit->distance >= nearest) continue;
    nearest = hit->distance;
    sample = {true, X_WP * hit->point, X_WP.linear() * hit->normal, body};
  }
  return sample;
}

void CellWorld::sample_cup(std::size_t cup, std::span<const Eigen::Vector3d> probes_G,
                           std::span<SurfaceSample> samples) const {
  const CupSpec& spec = cell_->gripper->cups()[cup];
  const Pose X_WL = hold_->X_WU(cup), X_GU = spec.X_GU, X_UG = spec.X_GU.inverse();
  double gap = kProbeRange;  // of the nearest point under the lip
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::Vector3d start_U = X_UG * probes_G[k] - Eigen::Vector3d(0, 0, kProbeBack);
    SurfaceSample& sample = samples[k];
    sample = first_hit(X_WL * start_U, X_WL.linear().col(2), kProbeRange);
    if (!sample.hit) continue;
    const Eigen::Vector3d point_U = X_WL.inverse() * sample.point_G;  // first_hit answers in W
    gap = std::min(gap, point_U.z());
    sample.point_G = X_GU * point_U;
    sample.normal_G = X_GU.linear() * X_WL.linear().transpose() * sample.normal_G;
  }
  const bool touches = gap <= spec.lip_compliance;
  const Eigen::Vector3d travel_G = X_GU.linear().col(2) * (touches ? -hold_->cups()[cup].compression : 0.0);
  for (SurfaceSample& sample : samples) sample.point_G += travel_G;
}

std::vector<SurfaceSample> CellWorld::probe_cups() const {
  const std::vector<Eigen::Vector3d> probes_G = cell_->gripper->probe_points_G();
  const std::size_t cups = cell_->gripper->cups().size(), each = probes_G.size() / cups;
  BP_CHECK(each * cups == probes_G.size(), probes_G.size() << " probe points for " << cups << " cups");
  std::vector<SurfaceSample> samples(probes_G.size());
  for (std::size_t c = 0; c < cups; ++c)
    sample_cup(c, std::span(probes_G).subspan(c * each, each), std::span(samples).subspan(c * each, each));
  return samples;
}

std::vector<std::pair<BodyId, std::string>> CellWorld::moving_bodies() const {
  std::vector<std::pair<BodyId, std::string>> bodies = {{tool_body, "tool"}};
  for (std::size_t l = kFirstMovingLink; l < link_bodies.size(); ++l)
    if (link_bodies[l] >= 0) bodies.push_back({link_bodies[l], cell_->arm->link_names()[l]});
  return bodies;
}

CellWorld::Touch CellWorld::arm_contact(const std::map<std::string, double>& in_contact) {
  Touch touch;
  for (const auto& [body, name] : moving_bodies()) {
    double force = 0;
    for (const World::BodyContact& contact : world_.contacts(body)) force += contact.force;
    if (force > touch.force) touch.force = force, touch.pushed = name + " on a part";
  }
  for (const auto& [name, depth] : in_contact)
    if (depth > touch.depth && name.rfind("lip", 0) != 0) touch.depth = depth, touch.entered = name;
  return touch;
}

std::map<std::string, double> CellWorld::cell_contacts() {
  std::map<std::string, double> found;
  for (const auto& [body, name] : moving_bodies()) {
    for (const auto& [fixed, fixed_name] :
         {std::pair{thin_bin_body_, "bin"}, {tray_body, "tray"}, {table_body, "table"}}) {
      const double depth = world_.overlap(body, fixed);
      if (depth > 0) found[name + " in the " + fixed_name] = depth;
    }
  }
  for (const BodyId lip : hold_->lips()) {
    for (const World::BodyContact& contact : world_.contacts(lip)) {
      if (world_.kind(contact.other) != World::BodyKind::kFixed || contact.force <= 0) continue;
      const char* other = contact.other == bin_body ? "bin" : contact.other == tray_body ? "tray" : "table";
      double& depth = found[std::string("lip on the ") + other];
      depth = std::max(depth, contact.depth);
    }
  }
  return found;
}

}  // namespace binpick
