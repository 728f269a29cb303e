#include "evaluation/bop_layout.hpp"

#include <algorithm>
#include <vector>

#include "core/error.hpp"

namespace binpick {

namespace fs = std::filesystem;

std::string six_digits(int number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

BopLayout::BopLayout(const std::string& root, const std::string& split, const std::string& sensor)
    : root_(root), sensor_(sensor) {
  if (!fs::is_directory(root)) throw AssetError(root + ": is no folder");
  canonical_ = fs::canonical(root);
  split_ = split.empty() ? only_split() : split;
  for (const std::string& name : {split_, sensor_})
    if (name.find('/') != std::string::npos || name == "..")
      throw SpecError("'" + name + "': split and sensor are names, not paths");
  if (!fs::is_directory(inside(split_))) throw AssetError(root + ": has no folder '" + split_ + "'");
}

bool BopLayout::has(const std::string& file) const { return fs::exists(fs::path(root_) / file); }

std::string BopLayout::inside(const std::string& file) const {
  const fs::path path = fs::path(root_) / file;
  const fs::path real = fs::weakly_canonical(path);
  const auto differ = std::mismatch(canonical_.begin(), canonical_.end(), real.begin(), real.end());
  if (differ.first != canonical_.end()) throw AssetError(path.string() + ": leads out of " + root_);
  return path.string();
}

std::string BopLayout::only_split() const {
  std::vector<std::string> found;
  for (const char* prefix : {"test", "val"}) {
    for (const auto& entry : fs::directory_iterator(root_))
      if (entry.is_directory() && entry.path().filename().string().rfind(prefix, 0) == 0)
        found.push_back(entry.path().filename().string());
    if (!found.empty()) break;
  }
  std::sort(found.begin(), found.end());
  if (found.size() == 1) return found.front();
  std::string names;
  for (const std::string& name : found) names += " " + name;
  throw SpecError(
      root_ + (found.empty() ? ": has no folder test*: name the split" : ": has several splits, name one:" + names));
}

}  // namespace binpick
