// A dense image, row-major, pixel (0,0) at the upper left.
#pragma once

#include <cstddef>
#include <vector>

#include "core/check.hpp"

namespace binpick {

template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T fill = T{})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool empty() const { return pixels_.empty(); }
  bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width_ && v < height_; }

  T& operator()(int u, int v) { return pixels_[static_cast<std::size_t>(v) * width_ + u]; }
  const T& operator()(int u, int v) const { return pixels_[static_cast<std::size_t>(v) * width_ + u]; }
  T& operator[](std::size_t i) { return pixels_[i]; }
  const T& operator[](std::size_t i) const { return pixels_[i]; }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }
  auto begin() { return pixels_.begin(); }
  auto end() { return pixels_.end(); }
  auto begin() const { return pixels_.begin(); }
  auto end() const { return pixels_.end(); }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace binpick
