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

TEST(CloudPcd, ReadsTextBinaryAndPointsWithoutReturn) {
  const TempFolder folder;
  const std::string text =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"
      "COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ascii\n"
      "0.5 -0.25 1 7\nnan nan nan 0\n0 0 2 9\n-0.125 0.0625 0.75 1\n";
  const PointCloud cloud = read_cloud(folder.put("cloud.pcd", text));
  ASSERT_EQ(cloud.size(), 3u);
  EXPECT_FALSE(cloud.has_normals());
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(0.5, -0.25, 1));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(cloud.points[2], Eigen::Vector3d(-0.125, 0.0625, 0.75));

  std::string binary =
      "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
      "COUNT 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
  for (const float value : {1.f, 2.f, 3.f, 0.f, 0.f, -2.f, 0.5f, 0.25f, 0.125f, 0.f, 0.f, 0.f})
    binary.append(reinterpret_cast<const char*>(&value), sizeof value);
  const PointCloud lit = read_cloud(folder.put("lit.pcd", binary));
  ASSERT_EQ(lit.size(), 2u);
  ASSERT_TRUE(lit.has_normals());
  EXPECT_EQ(lit.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(lit.normals[0], Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(lit.normals[1], Eigen::Vector3d::Zero());
}

TEST(BadCloud, OfPcdSaysWhatIsWrong) {
  const TempFolder folder;
  const auto head = [](const std::string& fields, const std::string& size, const std::string& type, int points) {
    std::string count;
    for (const char c : type)
      if (c != ' ') count += count.empty() ? "1" : " 1";
    return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count + "\nWIDTH " +
           std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\n";
  };
  const std::string xyz = head("x y z", "4 4 4", "F F F", 1);
  const std::pair<std::string, const char*> cases[] = {
      {"", "not a PCD file"},
      {"solid nothing\n", "not a PCD file"},
      {xyz, "not a PCD file"},
      {head("x y", "4 4", "F F", 1) + "DATA ascii\n0 0\n", "lack x, y or z"},
      {head("x y z", "4 4 4", "F F I", 1) + "DATA ascii\n0 0 1\n", "does not hold real numbers"},
      {xyz + "DATA binary\n1234", "not a PCD file"},
      {head("x y z", "4 4 4", "F F F", 2000000000) + "DATA binary\n123456789012", "not a PCD file"},
      {xyz + "DATA ascii\n0 0 4000\n", "clouds are in metres"},
  };
  for (const auto& [text, said] : cases) {
    try {
      read_cloud(folder.put("bad.pcd", text));
      ADD_FAILURE() << text;
    } catch (const AssetError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said)) << text;
      EXPECT_THAT(error.what(), HasSubstr("bad.pcd"));
    }
  }
  EXPECT_THROW(read_cloud(folder.at("missing.pcd")), AssetError);
  EXPECT_THROW(read_cloud(folder.put("cloud.xyz", "0 0 1\n")), AssetError);
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
