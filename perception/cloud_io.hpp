// Point clouds on disk: PLY, in metres. Written binary with float coordinates; read in any of PLY's three forms, with
// other properties of the points skipped. A file does not know its frame: the comment says it.
#pragma once

#include <string>

#include "core/point_cloud.hpp"

namespace binpick {

/// `comment` is one line of the header ("frame C, metres"). Throws StorageError.
void write_cloud_ply(const std::string& path, const PointCloud& cloud, const std::string& comment);

/// Normals come back when the file has nx, ny, nz: of length one, or zero where there is none. Throws AssetError: not a
/// PLY, counts its bytes do not meet, a coordinate that is no number or beyond 1 km.
PointCloud read_cloud_ply(const std::string& path);

}  // namespace binpick
