// Point clouds on disk: PLY and PCD, in metres. PLY is written binary with float coordinates and read in any of its
// three forms; PCD is read in any of its three (ascii, binary, binary_compressed). Other properties of the points are
// skipped. A PLY does not know its frame: the comment says it. The VIEWPOINT of a PCD is not applied: its points are
// taken in their own frame.
#pragma once

#include <string>

#include "core/point_cloud.hpp"

namespace binpick {

/// `comment` is one line of the header ("frame C, metres"). Throws StorageError.
void write_cloud_ply(const std::string& path, const PointCloud& cloud, const std::string& comment);

/// Normals come back when the file has nx, ny, nz: of length one, or zero where there is none. Throws AssetError: not a
/// PLY, counts its bytes do not meet, a coordinate that is no number or beyond 1 km.
PointCloud read_cloud_ply(const std::string& path);

/// Points without a return (NaN, as organised clouds hold them) are left out; normals come back when the file has
/// normal_x, normal_y, normal_z. Throws AssetError: not a PCD that can be read, x, y, z missing or no real numbers, a
/// coordinate beyond 1 km. The file is read in a process of its own, so that a crash of the reader is an error, too.
PointCloud read_cloud_pcd(const std::string& path);

/// One of the two by the file's extension. Throws AssetError.
PointCloud read_cloud(const std::string& path);

}  // namespace binpick
