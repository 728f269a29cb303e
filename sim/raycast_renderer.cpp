// A ray caster (Embree) behind the DepthRenderer interface: the exact reference of the rasteriser. One ray through
// every pixel centre, z = 1 along it, so that a ray's parameter is the depth and near and far clip by z of C. Embree
// works in float and only says which triangle comes first; the depth is that triangle's plane met in double
// (sim/facets).
//
// Of surfaces at the same (float) depth the earlier item wins, as in the rasteriser. Embree is held to one instruction
// set and one thread for building; rays go in fixed packets of eight along a row: no answer depends on `threads`.

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/facets.hpp"
#include "sim/picture.hpp"

namespace binpick {
namespace {

constexpr int kPacket = 8;
constexpr int kRowsAtOnce = 8;

// An Embree object with its share of the device's lifetime.
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePtr = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;
struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using DevicePtr = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;

void check_device(RTCDevice device, const char* where) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error(std::string("Embree, ") + where + ": error " + std::to_string(error));
}

ScenePtr new_scene(RTCDevice device, RTCBuildQuality quality) {
  ScenePtr scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(scene.get(), quality);
  return scene;
}

ScenePtr mesh_scene(RTCDevice device, const TriangleMesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), mesh.vertices.size()));
  auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  check_device(device, "mesh");
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int i = 0; i < 3; ++i) *points++ = static_cast<float>(p[i]);
  for (const auto& triangle : mesh.triangles) corners = std::copy(triangle.begin(), triangle.end(), corners);
  rtcCommitGeometry(geometry);
  ScenePtr scene = new_scene(device, RTC_BUILD_QUALITY_MEDIUM);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  check_device(device, "mesh");
  return scene;
}

// Meshes with their search trees, built once each. The key is the mesh object itself; the cache holds a share of it, so
// that its address cannot pass to another mesh.
class MeshCache {
 public:
  explicit MeshCache(RTCDevice device) : device_(device) {}
  struct Entry {
    std::shared_ptr<const TriangleMesh> source;
    ScenePtr scene;
    std::unique_ptr<const MeshFacets> facets;
  };
  const Entry& get(const std::shared_ptr<const TriangleMesh>& mesh) {
    Entry& entry = entries_[mesh.get()];
    if (entry.source == nullptr) entry = {mesh, mesh_scene(device_, *mesh), std::make_unique<const MeshFacets>(*mesh)};
    return entry;
  }
  void drop_unused() {
    std::erase_if(entries_, [](const auto& entry) { return entry.second.source.use_count() == 1; });
  }

 private:
  RTCDevice device_;
  std::map<const TriangleMesh*, Entry> entries_;
};

// What one packet has met so far. Embree hands a later hit at the same depth to the filter too.
struct PacketContext {
  RTCIntersectContext base;  // first: Embree knows this part only
  float depth[kPacket];
  std::uint32_t item[kPacket];
};

void keep_earlier_item(const RTCFilterFunctionNArguments* hits) {
  auto& best = *reinterpret_cast<PacketContext*>(hits->context);
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] != -1) continue;
    const unsigned lane = RTCRayN_id(hits->ray, hits->N, i);
    const float depth = RTCRayN_tfar(hits->ray, hits->N, i);
    const std::uint32_t item = RTCHitN_instID(hits->hit, hits->N, i, 0);
    if (depth == best.depth[lane] && item > best.item[lane]) {
      hits->valid[i] = 0;
    } else {
      best.depth[lane] = depth;
      best.item[lane] = item;
    }
  }
}

class RaycastRenderer : public DepthRenderer {
 public:
  explicit RaycastRenderer(int threads)
      : threads_(std::max(threads, 1)), device_(rtcNewDevice("threads=1,isa=avx2")), meshes_(device_.get()) {
    if (!device_) throw std::runtime_error("Embree gives no device");
  }

  ExactFrame render(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC, double near,
                    double far) override {
    BP_CHECK(near > 0 && far > near, near << " .. " << far);
    meshes_.drop_unused();
    FacetView view{scene, camera, near, far, {}, {}, threads_};
    const ScenePtr rays = place(X_WC.inverse(), view);
    Image<FacetId> seen(camera.width, camera.height);
    const std::size_t blocks = static_cast<std::size_t>((camera.height + kRowsAtOnce - 1) / kRowsAtOnce);
    parallel_for(blocks, threads_, [&](std::size_t block) {
      const int first = static_cast<int>(block) * kRowsAtOnce;
      for (int v = first; v < std::min(first + kRowsAtOnce, camera.height); ++v)
        for (int u = 0; u < camera.width; u += kPacket) shoot(view, rays.get(), u, v, seen);
    });
    check_device(device_.get(), "render");
    return frame_of(view, seen);
  }

  Image<Rgb> picture(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC) override {
    return shaded_picture(*this, scene, camera, X_WC);
  }

  std::string description() const override { return "Embree " RTC_VERSION_STRING ", ray caster"; }

 private:
  // The items as instances, in C; instance id = item.
  ScenePtr place(const Pose& X_CW, FacetView& view) {
    ScenePtr rays = new_scene(device_.get(), RTC_BUILD_QUALITY_LOW);
    for (std::size_t i = 0; i < view.scene.items.size(); ++i) {
      const RenderItem& item = view.scene.items[i];
      BP_CHECK(item.mesh_O != nullptr);
      view.X_CO.push_back(X_CW * item.X_WO);
      view.facets.push_back(nullptr);
      if (item.mesh_O->empty()) continue;
      const MeshCache::Entry& mesh = meshes_.get(item.mesh_O);
      view.facets.back() = mesh.facets.get();
      if (!may_be_seen(view, i)) continue;
      const RTCGeometry instance = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, mesh.scene.get());
      const Eigen::Matrix4f X = view.X_CO.back().matrix().cast<float>();
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, X.data());
      rtcCommitGeometry(instance);
      rtcAttachGeometryByID(rays.get(), instance, static_cast<unsigned>(i));
      rtcReleaseGeometry(instance);
    }
    rtcCommitScene(rays.get());
    check_device(device_.get(), "scene");
    return rays;
  }

  // One packet: pixels u .. u + 7 of row v.
  static void shoot(const FacetView& view, RTCScene rays, int u, int v, Image<FacetId>& seen) {
    alignas(32) int valid[kPacket];
    alignas(32) RTCRayHit8 packet;
    PacketContext context;
    rtcInitIntersectContext(&context.base);
    context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.base.filter = keep_earlier_item;
    for (int i = 0; i < kPacket; ++i) {
      valid[i] = u + i < view.camera.width ? -1 : 0;
      const Eigen::Vector3f ray = view.camera.ray(u + i, v).cast<float>();
      packet.ray.org_x[i] = packet.ray.org_y[i] = packet.ray.org_z[i] = packet.ray.time[i] = 0;
      packet.ray.dir_x[i] = ray.x();
      packet.ray.dir_y[i] = ray.y();
      packet.ray.dir_z[i] = 1;
      packet.ray.tnear[i] = static_cast<float>(view.near);
      packet.ray.tfar[i] = static_cast<float>(view.far);
      packet.ray.mask[i] = ~0u;
      packet.ray.id[i] = static_cast<unsigned>(i);
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      context.depth[i] = -1;
      context.item[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, rays, &context.base, &packet);
    for (int i = 0; i < kPacket; ++i)
      if (valid[i] && packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
        seen(u + i, v) = {static_cast<std::int32_t>(packet.hit.instID[0][i]),
                          static_cast<std::int32_t>(packet.hit.primID[i])};
  }

  int threads_;
  DevicePtr device_;  // first in, last out
  MeshCache meshes_;
};

}  // namespace

std::unique_ptr<DepthRenderer> make_raycast_renderer(int threads) { return std::make_unique<RaycastRenderer>(threads); }

}  // namespace binpick
