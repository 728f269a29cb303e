// What can be wrong with the things a user hands us. The message is one readable line that names file and place.
#pragma once

#include <stdexcept>
#include <string>

namespace binpick {

/// A scene, a command line or a configuration that cannot be meant. Thrown while loading; the program exits with 2.
class SpecError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A CAD file, image or other asset that cannot be used. Thrown while loading; the program exits with 2.
class AssetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The disk is full, read-only or broken. The program exits with 6.
class StorageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace binpick
