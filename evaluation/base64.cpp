#include "evaluation/base64.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace binpick {

std::string base64(const std::string& bytes) {
  using namespace boost::archive::iterators;
  // Six bits at a time; the last group reads the zero behind a string's end.
  using Encoder = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Encoder(bytes.begin()), Encoder(bytes.end()));
  return text.append((4 - text.size() % 4) % 4, '=');
}

}  // namespace binpick
