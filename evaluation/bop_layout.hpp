// Private to this folder: where the files of a BOP data set lie (scenewise format). None may lie outside its root.
#pragma once

#include <filesystem>
#include <string>

namespace binpick {

/// 7 -> "000007"
std::string six_digits(int number);

class BopLayout {
 public:
  /// An empty split: the only folder that begins with test, or else val. Throws AssetError: no such folder; SpecError:
  /// several splits, names that are paths.
  BopLayout(const std::string& root, const std::string& split, const std::string& sensor);

  const std::string& split() const { return split_; }
  bool has(const std::string& file) const;
  /// The file's path. Throws AssetError when it is not inside the root, whatever links there are.
  std::string inside(const std::string& file) const;
  /// "depth" -> "depth_cam1"
  std::string with_sensor(const std::string& name) const { return sensor_.empty() ? name : name + "_" + sensor_; }
  /// Folder of a scene, with its slash at the end.
  std::string scene(int id) const { return split_ + "/" + six_digits(id) + "/"; }

 private:
  std::string only_split() const;
  std::string root_, sensor_, split_;
  std::filesystem::path canonical_;
};

}  // namespace binpick
