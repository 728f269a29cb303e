// PLY bytes as a point cloud.
#include "perception/cloud_io.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("input.ply");
  const std::string& path = file.put(data, size);
  binpick::fuzz::accepts(path, [&] {
    const binpick::PointCloud cloud = binpick::read_cloud_ply(path);
    for (const Eigen::Vector3d& p : cloud.points)
      if (!p.allFinite()) binpick::fuzz::finding("a point that is no number", path);
  });
  return 0;
}
