// One pair of the model in the table: 32 bits. Free of Eigen, so that the wide kernels can read it.
#pragma once

#include <cstdint>

namespace binpick {

struct PairEntry {
  std::uint16_t alpha = 0;      ///< of the partner about the reference's normal, turns / 65536
  std::uint16_t reference = 0;  ///< index into PairTable::references()
};

}  // namespace binpick
