#include "tools/bench/perception_heaps.hpp"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/file_io.hpp"
#include "core/bin_mesh.hpp"
#include "core/hash.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormat = 1;  // a change of it empties every store

void add_mesh(Hasher& hasher, const TriangleMesh& mesh) {
  hasher.add(std::uint64_t{mesh.vertices.size()});
  for (const Eigen::Vector3d& v : mesh.vertices) hasher.add(v.x()).add(v.y()).add(v.z());
}

void add_shapes(Hasher& hasher, const std::vector<Primitive>& shapes) {
  for (const Primitive& s : shapes)
    hasher.add(static_cast<std::uint64_t>(s.kind)).add(s.size.x()).add(s.size.y()).add(s.size.z()).add(s.X_OS);
}

void add_part(Hasher& hasher, const Part& part, const CollisionShape& shape, int count) {
  hasher.add(static_cast<std::uint64_t>(count)).add(part.friction).add(part.restitution).add(part.diameter);
  hasher.add(part.mass.mass);
  for (int i = 0; i < 3; ++i) hasher.add(part.mass.center_P[i]);
  for (int i = 0; i < 9; ++i) hasher.add(part.mass.inertia_P.data()[i]);
  for (const TriangleMesh& piece : shape.pieces_P) add_mesh(hasher, piece);
}

template <class Config>
void add_config(Hasher& hasher, Config config) {
  hasher.add(write_yaml([&](ConfigVisitor& v) { config.visit(v); }));
}

std::uint64_t bits_of(const SettledHeap& heap) {
  Hasher hasher;
  hasher.add(std::uint64_t{heap.usable});
  for (std::size_t i = 0; i < heap.parts.size(); ++i) {
    hasher.add(std::uint64_t{heap.parts[i]});
    hasher.bytes(heap.X_WP[i].matrix().data(), 16 * sizeof(double));
  }
  return hasher.value();
}

Json pose_json(const Pose& X) {
  Json json = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) json.push_back(X.matrix()(row, column));
  return json;
}

Pose pose_of(const Json& json) {
  Pose X = Pose::Identity();
  for (int i = 0; i < 12; ++i) X.matrix()(i / 4, i % 4) = json.at(static_cast<std::size_t>(i)).get<double>();
  return X;
}

std::string text_of(const SettledHeap& heap, const std::string& key, std::uint64_t seed) {
  Json json;
  json["format"] = kFormat;
  json["key"] = key;
  json["seed"] = seed;
  json["usable"] = heap.usable;
  json["bodies"] = Json::array();
  for (std::size_t i = 0; i < heap.parts.size(); ++i)
    json["bodies"].push_back({{"part", heap.parts[i]}, {"X_WP", pose_json(heap.X_WP[i])}});
  json["bits"] = hex(bits_of(heap));
  return json.dump(1) + "\n";
}

/// What a file holds; nothing when it is not there, damaged or another heap's.
std::optional<SettledHeap> read_heap(const std::string& file, const std::string& key, std::uint64_t seed) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const Json json = Json::parse(read_file(file));
    if (json.at("format") != kFormat || json.at("key") != key || json.at("seed") != seed) return std::nullopt;
    SettledHeap heap;
    heap.usable = json.at("usable").get<bool>();
    for (const Json& body : json.at("bodies")) {
      heap.parts.push_back(body.at("part").get<std::size_t>());
      heap.X_WP.push_back(pose_of(body.at("X_WP")));
    }
    if (json.at("bits") != hex(bits_of(heap))) return std::nullopt;
    return heap;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

SettledHeap drop(const Scenario& scenario, const TrialContext& context, std::uint64_t seed) {
  CellWorld cell_world(scenario.cell, scenario.physics, context.parts);
  const DropResult result = drop_heap(scenario, context, Seed{seed}, cell_world);
  SettledHeap heap;
  heap.usable = result.settled && result.escaped.empty();
  heap.parts = result.parts;
  for (std::size_t i = 0; i < result.bodies.size(); ++i) heap.X_WP.push_back(cell_world.part_pose(i));
  return heap;
}

}  // namespace

bool SettledHeap::operator==(const SettledHeap& other) const {
  if (usable != other.usable || parts != other.parts) return false;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (std::memcmp(X_WP[i].matrix().data(), other.X_WP[i].matrix().data(), 16 * sizeof(double)) != 0) return false;
  return true;
}

std::string heap_key(const Scenario& scenario, const TrialContext& context) {
  Hasher hasher;
  for (std::size_t p = 0; p < context.parts.size(); ++p)
    add_part(hasher, context.parts[p], context.shapes[p], context.counts[p]);
  add_config(hasher, scenario.drop);
  add_config(hasher, scenario.settle);
  add_config(hasher, scenario.physics);
  add_config(hasher, scenario.cell.bin);
  if (scenario.cell.bin.solid) add_mesh(hasher, scenario.cell.bin.solid->mesh_B);
  hasher.add(scenario.cell.X_WB);
  add_shapes(hasher, scenario.cell.table_W());
  add_shapes(hasher, scenario.cell.tray_W());
  return hex(hasher.value());
}

const SettledHeap& HeapStore::heap(const Scenario& scenario, const TrialContext& context, std::uint64_t seed) {
  const std::string key = heap_key(scenario, context);
  const auto [place, fresh] = known_.try_emplace({key, seed});
  if (!fresh) return place->second;
  const std::string folder = folder_ + "/" + key, file = folder + "/" + std::to_string(seed) + ".json";
  if (!folder_.empty())
    if (std::optional<SettledHeap> stored = read_heap(file, key, seed)) return place->second = std::move(*stored);
  place->second = drop(scenario, context, seed);
  ++dropped_;
  if (!folder_.empty()) make_folder(folder), write_file(file, text_of(place->second, key, seed));
  return place->second;
}

void place_heap(const SettledHeap& heap, CellWorld& cell_world) {
  DropResult drop;
  drop.settled = true;
  drop.parts = heap.parts;
  // A body without shape: its frame is the part's own, so that the stored bits come back unchanged.
  for (const Pose& X_WP : heap.X_WP) drop.bodies.push_back(cell_world.world().add_fixed({}, X_WP, {}));
  cell_world.set_heap(drop);
}

}  // namespace binpick
