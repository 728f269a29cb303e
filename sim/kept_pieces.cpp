#include "sim/kept_pieces.hpp"

#include "core/byte_stream.hpp"

namespace binpick {
namespace {

constexpr std::uint32_t kPiecesVersion = 2;  // of convex_decomposition: raised whenever it gives other pieces

std::vector<TriangleMesh> read_pieces(std::string_view bytes) {
  ByteReader in(bytes);
  // The shortest piece is two empty lists.
  std::vector<TriangleMesh> pieces(static_cast<std::size_t>(in.length(2 * sizeof(std::uint64_t))));
  for (TriangleMesh& piece : pieces) {
    in.get(piece.vertices).get(piece.triangles);
    for (const auto& t : piece.triangles)
      for (const std::uint32_t corner : t)
        if (corner >= piece.vertices.size()) return {};
  }
  return in.done() ? pieces : std::vector<TriangleMesh>{};
}

std::string bytes_of(const std::vector<TriangleMesh>& pieces) {
  ByteWriter out;
  out.add(static_cast<std::uint64_t>(pieces.size()));
  for (const TriangleMesh& piece : pieces) out.add(piece.vertices).add(piece.triangles);
  return out.bytes();
}

}  // namespace

CacheKey pieces_key(const TriangleMesh& mesh, const DecompositionLimits& limits) {
  ByteWriter inputs;
  inputs.add(mesh.vertices).add(mesh.triangles);
  inputs.add(limits.convex_enough).add(limits.piece_air).add(limits.aim_air).add(limits.max_air).add(limits.round_loss);
  for (const std::size_t count : {limits.aim_pieces, limits.max_pieces, limits.max_vertices})
    inputs.add(static_cast<std::uint64_t>(count));
  inputs.add(limits.tolerance).add(static_cast<std::int64_t>(limits.cells));
  return {"convex_pieces", kPiecesVersion, content_hash(inputs.bytes())};
}

std::vector<TriangleMesh> kept_decomposition(const TriangleMesh& mesh, const DecompositionLimits& limits,
                                             const DiskCache& cache) {
  if (!cache.in_use()) return convex_decomposition(mesh, limits);
  const CacheKey key = pieces_key(mesh, limits);
  if (const auto bytes = cache.load(key)) {
    std::vector<TriangleMesh> pieces = read_pieces(*bytes);
    if (!pieces.empty()) return pieces;
  }
  std::vector<TriangleMesh> pieces = convex_decomposition(mesh, limits);
  if (pieces.size() > 1) cache.store(key, bytes_of(pieces));  // a hull is quick to make
  return pieces;
}

}  // namespace binpick
