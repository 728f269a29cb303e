#include "core/mesh_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/mesh_properties.hpp"
#include "core/primitive.hpp"

namespace binpick {
namespace {

/// A folder of this test's own, gone at the end.
class MeshIo : public testing::Test {
 protected:
  MeshIo() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = (std::filesystem::temp_directory_path() /
               (std::string("binpick_mesh_io_") + info->name() + "_" + std::to_string(::getpid())))
                  .string();
    std::filesystem::create_directories(folder_);
  }
  ~MeshIo() override { std::filesystem::remove_all(folder_); }
  std::string at(const std::string& name) const { return folder_ + "/" + name; }
  std::string put(const std::string& name, const std::string& bytes) const {
    write_file(at(name), bytes);
    return at(name);
  }
  std::string folder_;
};

const TriangleMesh& block() {  // 60 x 40 x 20 mm, off its origin
  static const TriangleMesh mesh =
      mesh_of(Primitive::box({0.06, 0.04, 0.02}, Pose(Eigen::Translation3d(0.01, 0.02, 0.03))));
  return mesh;
}

void expect_block(const TriangleMesh& mesh, double tolerance) {
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  const MassProperties m = mass_properties(mesh, 1);
  EXPECT_NEAR(m.volume, 4.8e-5, 4.8e-5 * tolerance);
  EXPECT_LT((m.center_P - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 0.06 * tolerance);
  EXPECT_NEAR(mesh_diameter(mesh), std::sqrt(0.0056), 0.06 * tolerance);
}

TEST_F(MeshIo, StlRoundTrip) {
  write_stl(at("block.stl"), block());
  MeshReadReport report;
  const TriangleMesh mesh = read_mesh(at("block.stl"), {}, &report);
  expect_block(mesh, 1e-6);  // float coordinates
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.dropped_triangles, 0u);
  EXPECT_FALSE(report.turned_inside_out);
}

TEST_F(MeshIo, PlyRoundTrip) {
  write_ply(at("block.ply"), block());
  expect_block(read_mesh(at("block.ply")), 1e-6);
}

}  // namespace
}  // namespace binpick
