// PLY clouds: what is written reads back, other programs' files read, damaged ones are refused by name.

#include "perception/cloud_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/random.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

PointCloud some_cloud(bool normals) {
  PointCloud cloud;
  Rng rng = Seed{1}.child("test/cloud").rng();
  for (int i = 0; i < 500; ++i) {
    // Floats, so that nothing is lost on the way.
    cloud.points.push_back(Eigen::Vector3f(rng.unit_vector().cast<float>()).cast<double>());
    if (normals) cloud.normals.push_back(i % 50 == 0 ? Eigen::Vector3d::Zero() : rng.unit_vector());
  }
  return cloud;
}

TEST(CloudIo, WhatIsWrittenReadsBack) {
  const TempFolder folder;
  for (const bool normals : {false, true}) {
    const PointCloud cloud = some_cloud(normals);
    write_cloud_ply(folder.at("cloud.ply"), cloud, "frame C, metres");
    const PointCloud back = read_cloud_ply(folder.at("cloud.ply"));
    ASSERT_EQ(back.size(), cloud.size());
    ASSERT_EQ(back.has_normals(), normals);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(back.points[i], cloud.points[i]);
      if (normals) {
        EXPECT_LT((back.normals[i] - cloud.normals[i]).norm(), 1e-6);
      }
    }
    EXPECT_THAT(read_file(folder.at("cloud.ply")), HasSubstr("comment frame C, metres\n"));
  }
}

TEST(CloudIo, AnEmptyCloudIsACloud) {
  const TempFolder folder;
  write_cloud_ply(folder.at("cloud.ply"), {}, "nothing");
  EXPECT_EQ(read_cloud_ply(folder.at("cloud.ply")).size(), 0u);
}

TEST(CloudIo, ReadsTextWithColoursAndFaces) {
  const TempFolder folder;
  const std::string path = folder.put("cloud.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty uchar red\n"
                                      "property double y\nproperty double z\nelement face 1\n"
                                      "property list uchar int vertex_indices\nend_header\n"
                                      "0.5 255 -0.25 1\n0 0 0 2\n3 0 1 1\n");
  const PointCloud cloud = read_cloud_ply(path);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_FALSE(cloud.has_normals());
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(0.5, -0.25, 1));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3d(0, 0, 2));
}

TEST(BadCloud, SaysWhatIsWrong) {
  const TempFolder folder;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::pair<std::string, const char*> cases[] = {
      {"", "does not start with 'ply'"},
      {"ply\nformat ascii 1.0\n", "does not end"},
      {head + "property float x\nproperty float y\nend_header\n0 0\n", "lack x, y or z"},
      {head + xyz + "property float nx\nend_header\n0 0 1 0\n", "normals lack"},
      {head + xyz + "property float x\nend_header\n0 0 1 0\n", "x twice"},
      {head + xyz + "end_header\n", "before the counts"},
      {head + xyz + "end_header\n0 0 1\n0 0 1\n", "more lines"},
      {head + xyz + "end_header\n0 nan 1\n", "cloud.ply:8"},
      {head + xyz + "end_header\n0 0 4000\n", "clouds are in metres"},
      {"ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n", "no vertices"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz + "end_header\nabcd", "before the counts"},
  };
  for (const auto& [text, said] : cases) {
    const std::string path = folder.put("cloud.ply", text);
    try {
      read_cloud_ply(path);
      FAIL() << "accepted: " << text;
    } catch (const AssetError& error) {
      EXPECT_THAT(error.what(), HasSubstr("cloud.ply"));
      EXPECT_THAT(error.what(), HasSubstr(said));
    }
  }
  EXPECT_THROW(read_cloud_ply(folder.at("missing.ply")), AssetError);
}

}  // namespace
}  // namespace binpick
