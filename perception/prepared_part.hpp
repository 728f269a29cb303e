// What the search needs of a part, prepared once from its CAD: pair tables of surface and edges (paper 4), the surface
// with the views it is seen from, the part's self-overlaps. Frame P, metres.
#pragma once

#include <vector>

#include "core/disk_cache.hpp"
#include "core/part.hpp"
#include "perception/pair_table.hpp"
#include "perception/ppf_settings.hpp"
#include "perception/self_overlap.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

struct PreparedPart {
  double diameter = 0;
  double thinnest = 0;
  Symmetry symmetry;
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
  PairTable table, edge_table;
  SurfaceModel surface;
  std::vector<SelfOverlap> overlaps;
  std::vector<Vector6d> twists;  ///< of a continuous symmetry
};

/// Computes. Uses two threads; their number changes nothing.
PreparedPart prepare_part(const Part& part, const PpfSettings& settings);

/// The same bits, from the disk when they are there, else computed and kept there.
PreparedPart prepare_part(const Part& part, const PpfSettings& settings, const DiskCache& cache);

/// What is kept on disk of a prepared part; the rest is read off the part at once. `key` names it: mesh, symmetry and
/// all settings that decide it.
CacheKey prepared_part_key(const Part& part, const PpfSettings& settings);
void write_prepared(const PreparedPart& prepared, ByteWriter& out);
/// False when these are not the bytes of this part under these settings; never reads beyond them, whatever they are.
bool read_prepared(ByteReader& in, const Part& part, const PpfSettings& settings, PreparedPart& prepared);

}  // namespace binpick
