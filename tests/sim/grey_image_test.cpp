// Grey images against paper: where markers lie, with and without a lens, how strong light and noise are.

#include "sim/grey_image.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/primitive.hpp"

namespace binpick {
namespace {

constexpr double kPlate = 0.2;  // m, edge of the square marker plate

/// A plate facing the camera at `X_CO` (O's z towards the camera), seen from the world's origin looking along +z.
struct PlateScene {
  PlateScene(const Image<std::uint8_t>& print, const Pose& X_WO) {
    RenderItem item;
    TriangleMesh mesh;
    const double h = kPlate / 2;
    mesh.vertices = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    item.mesh_O = std::make_shared<const TriangleMesh>(mesh);
    item.X_WO = X_WO;
    item.id = 0;
    item.texture = std::make_shared<const SurfaceTexture>(print, Eigen::Vector2d(kPlate, kPlate));
    scene.items.push_back(item);
  }
  RenderScene scene;
};

/// Camera that looks down from `height` above the world's origin; image x along the world's x.
Pose above(double height) { return pose_from_xyz_rpy({0, 0, height}, {M_PI, 0, 0}); }

PinholeCamera small_camera() { return {200, 160, 300, 300, 99.5, 79.5}; }

GreyConfig quiet() {
  GreyConfig config;
  config.ambient = 1;  // no lamp: grey is reflectance
  config.white = 255;
  return config;
}

Image<std::uint8_t> chessboard(int squares) {
  Image<std::uint8_t> image(squares, squares);
  for (int v = 0; v < squares; ++v)
    for (int u = 0; u < squares; ++u) image(u, v) = (u + v) % 2 == 0 ? 0 : 255;
  return image;
}

/// A white disc of radius `r` at p_O on black, drawn finely.
Image<std::uint8_t> disc(const Eigen::Vector2d& p_O, double r) {
  constexpr int kSide = 1000, kSub = 4;
  Image<std::uint8_t> image(kSide, kSide, 0);
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      int in = 0;
      for (int j = 0; j < kSub; ++j)
        for (int i = 0; i < kSub; ++i) {
          const double x = ((u + (i + 0.5) / kSub) / kSide - 0.5) * kPlate;
          const double y = (0.5 - (v + (j + 0.5) / kSub) / kSide) * kPlate;
          in += (Eigen::Vector2d(x, y) - p_O).norm() <= r;
        }
      image(u, v) = static_cast<std::uint8_t>(255 * in / (kSub * kSub));
    }
  return image;
}

template <class Pixel>
Eigen::Vector2d centroid(const Image<Pixel>& image) {
  double sum = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      sum += image(u, v);
      at += image(u, v) * Eigen::Vector2d(u, v);
    }
  return at / sum;
}

class GreyImage : public testing::Test {
 protected:
  Image<float> light(const PlateScene& plate, const GreyCamera& camera, const GreyConfig& config) {
    return grey_light(*renderer_, plate.scene, camera, config);
  }
  std::unique_ptr<DepthRenderer> renderer_ = make_osmesa_renderer();
};

TEST(SurfaceTexture, MeansOnPaper) {
  Image<std::uint8_t> print(4, 2, 0);
  print(0, 0) = 255;  // upper left: x -2 .. -1, y 0 .. 1
  print(3, 1) = 51;   // lower right: 0.2
  const SurfaceTexture texture(print, {4, 2});
  const Eigen::Vector2d point(0, 0);
  EXPECT_NEAR(texture.mean({-1.5, 0.5}, point), 1, 1e-6);
  EXPECT_NEAR(texture.mean({1.5, -0.5}, point), 0.2, 1e-6);
  EXPECT_NEAR(texture.mean({1.5, 0.5}, point), 0, 1e-6);
  EXPECT_NEAR(texture.mean({-1, 0.5}, {0.5, 0.25}), 0.5, 1e-6);  // half of it over the edge
  EXPECT_NEAR(texture.mean({0, 0}, {2, 1}), 1.2 / 8, 1e-6);      // everything
  EXPECT_NEAR(texture.mean({-5, 0.9}, point), 1, 1e-6);          // its edge continued
  EXPECT_TRUE(texture.covers({1.99, -0.99}));
  EXPECT_FALSE(texture.covers({1.99, -1.01}));
}

// The corner where four squares meet, found on each side by where the step from dark to light lies.
TEST_F(GreyImage, ChessboardCornerLiesWhereItIsProjected) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.0031, -0.0017), Eigen::Vector2d(-0.0123, 0.0048)}) {
    Pose X_WO = Pose::Identity();
    X_WO.translation() = Eigen::Vector3d(shift.x(), shift.y(), 0);
    const PlateScene plate(chessboard(2), X_WO);
    const GreyCamera camera{small_camera(), {}, above(0.6)};
    GreyConfig config = quiet();
    config.blur = 0.8;
    const Image<float> image = light(plate, camera, config);
    const Eigen::Vector2d corner = camera.intrinsics.project(camera.X_WC.inverse() * X_WO.translation());
    // Rows well above the corner: dark left, light right; the sum of light says where it begins.
    const int v = static_cast<int>(corner.y()) - 20, u = static_cast<int>(corner.x()) - 20;
    double right = 0, below = 0;
    for (int k = 0; k < 40; ++k) right += image(u + k, v), below += image(u, v + k);
    EXPECT_NEAR(u - 0.5 + (40 - right), corner.x(), 0.01);  // pixel u begins at u - 0.5
    EXPECT_NEAR(v - 0.5 + (40 - below), corner.y(), 0.01);
    EXPECT_NEAR(image(u, v), 0, 1e-6);  // O's upper left square is dark
    EXPECT_NEAR(image(u + 39, v), 1, 1e-6);
  }
}

TEST_F(GreyImage, DiscThroughALensLiesWhereItIsProjected) {
  const LensDistortion lenses[] = {{}, {-0.25, 0.08, 0.002, -0.001, 0}, {0.2, 0, 0, 0.003, 0}};
  const Eigen::Vector2d p_O(0.052, -0.033);
  const PlateScene plate(disc(p_O, 0.012), Pose::Identity());
  const Eigen::Vector3d p_W(p_O.x(), p_O.y(), 0);
  for (const LensDistortion& lens : lenses) {
    GreyCamera camera{small_camera(), lens, above(0.4)};
    ASSERT_NO_THROW(lens.validate(camera.intrinsics));
    const Image<float> image = light(plate, camera, quiet());
    // The mean of the disc's own projected points: a lens moves the middle of a disc a little off its projected centre.
    Eigen::Vector2d expected = Eigen::Vector2d::Zero();
    double weight = 0;
    for (int i = -40; i <= 40; ++i)
      for (int j = -40; j <= 40; ++j) {
        const Eigen::Vector2d step(i * 0.012 / 40, j * 0.012 / 40);
        if (step.norm() > 0.012) continue;
        const auto pixel_of = [&](double dx, double dy) {
          return project(
              camera.intrinsics, lens,
              camera.X_WC.inverse() * Eigen::Vector3d(p_W + Eigen::Vector3d(step.x() + dx, step.y() + dy, 0)));
        };
        const Eigen::Vector2d x = pixel_of(1e-5, 0) - pixel_of(-1e-5, 0), y = pixel_of(0, 1e-5) - pixel_of(0, -1e-5);
        const double area = std::abs(x.x() * y.y() - x.y() * y.x());  // of the image that this bit of the disc covers
        expected += area * pixel_of(0, 0);
        weight += area;
      }
    expected /= weight;
    EXPECT_LT((centroid(image) - expected).norm(), 0.02) << "k1 " << lens.k1;
    EXPECT_LT((centroid(image) - project(camera.intrinsics, lens, camera.X_WC.inverse() * p_W)).norm(), 0.05);
    if (!lens.none()) {
      EXPECT_GT((expected - camera.intrinsics.project(camera.X_WC.inverse() * p_W)).norm(), 0.2);  // the lens matters
    }
    // With noise and whole grey levels, too: a few hundredths of a pixel.
    GreyConfig noisy = quiet();
    noisy.white = 230;
    const Image<std::uint8_t> picture = capture_grey(*renderer_, plate.scene, camera, noisy, Seed{5});
    Image<double> part(picture.width(), picture.height(), 0.0);
    for (int v = 0; v < part.height(); ++v)
      for (int u = 0; u < part.width(); ++u)
        if ((Eigen::Vector2d(u, v) - expected).norm() < 14) part(u, v) = picture(u, v);
    EXPECT_LT((centroid(part) - expected).norm(), 0.05) << "k1 " << lens.k1;
  }
}

TEST_F(GreyImage, AnEdgeThatIsStraightBendsByTheLens) {
  // The plate's upper edge, y = 0.1 at 0.4 m: the line y = -0.25 of the plane z = 1, barrel of -0.2. At x = 0 it is
  // seen at 0.25 (1 - 0.2 * 0.0625), at x = 0.2 at 0.25 (1 - 0.2 * 0.1025), times f = 300: 74.0625 and 73.4625 px above
  // the axis; its own column there is 0.2 (1 - 0.2 * 0.1025) * 300 = 58.77 px right of it.
  const GreyCamera camera{small_camera(), {-0.2, 0, 0, 0, 0}, above(0.4)};
  const PlateScene plate(Image<std::uint8_t>(1, 1, 255), Pose::Identity());
  GreyConfig config = quiet();
  config.supersampling = 4;
  const Image<float> image = light(plate, camera, config);
  const auto edge_above_axis = [&](double column) {
    const int u = static_cast<int>(std::floor(column));
    double lit[2] = {0, 0};
    for (int k = 0; k < 2; ++k)
      for (int v = 0; v < 79; ++v) lit[k] += image(u + k, v);
    return lit[0] + (column - u) * (lit[1] - lit[0]) + 1;  // rows 0 .. 78 end 1 px above the axis
  };
  // The frame behind a lens is drawn in pixels of its own, 1/4 px wide: the outline of an item is that coarse in
  // places.
  EXPECT_NEAR(edge_above_axis(99.5), 74.0625, 0.13);
  EXPECT_NEAR(edge_above_axis(99.5 + 58.77), 73.4625, 0.13);
}

TEST_F(GreyImage, NoLensIsThePinhole) {
  const PlateScene plate(chessboard(8), Pose::Identity());
  GreyCamera camera{small_camera(), {}, above(0.5)};
  const Image<float> pinhole = light(plate, camera, quiet());
  camera.lens.k1 = 1e-9;  // takes the other way through the code
  const Image<float> nearly = light(plate, camera, quiet());
  double difference = 0;
  for (std::size_t i = 0; i < pinhole.size(); ++i) difference += std::abs(pinhole[i] - nearly[i]);
  EXPECT_LT(difference / static_cast<double>(pinhole.size()), 0.01);
}

TEST_F(GreyImage, FineTexturesAverageOut) {
  // 500 squares over 150 px: every pixel holds eleven of them and more; far from the plate's edge all is middle grey.
  const PlateScene plate(chessboard(500), Pose::Identity());
  const Image<float> image = light(plate, {small_camera(), {}, above(0.4)}, quiet());
  for (int v = 40; v < 120; ++v)
    for (int u = 40; u < 160; ++u) ASSERT_NEAR(image(u, v), 0.5, 0.06) << u << ' ' << v;
}

TEST_F(GreyImage, LightFollowsTheLampAndShadows) {
  // A white plate that faces the lamp is 1, ambient included; a plate over it takes the lamp away.
  const Eigen::Vector3d to_lamp = Eigen::Vector3d(0.28, -0.24, 1.0).normalized();
  Pose X_WO = Pose::Identity();
  X_WO.linear() = rotation_with_z(to_lamp);
  PlateScene plate(Image<std::uint8_t>(1, 1, 255), X_WO);
  GreyConfig config;
  const GreyCamera camera{small_camera(), {}, above(0.5)};
  EXPECT_NEAR(light(plate, camera, config)(100, 80), 1, 0.005);  // the lamp hangs a few plates away
  RenderItem roof = plate.scene.items[0];
  roof.id = 1;
  roof.texture = nullptr;
  roof.X_WO.translation() = 0.25 * to_lamp;  // beside the line of sight, between plate and lamp
  const Eigen::Vector2d pixel = camera.intrinsics.project(camera.X_WC.inverse() * Eigen::Vector3d(-0.06, 0.06, 0));
  plate.scene.items.push_back(roof);
  const Image<float> shaded = light(plate, camera, config);
  const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
  EXPECT_NEAR(shaded(u, v), config.ambient, 0.005);
}

TEST(GreyExposure, NoiseIsThatOfItsElectrons) {
  GreyConfig config;
  config.white = 200;
  for (const double level : {0.1, 0.5, 1.0}) {
    const Image<float> light(300, 200, static_cast<float>(level));
    const Image<std::uint8_t> image = expose_grey(light, config, Seed{11});
    double sum = 0, squares = 0;
    for (const std::uint8_t grey : image) sum += grey, squares += double(grey) * grey;
    const double n = static_cast<double>(image.size()), mean = sum / n, variance = squares / n - mean * mean;
    const double k = config.full_well / 255, electrons = level * config.white * k;
    const double expected = (electrons + config.read_noise * config.read_noise) / (k * k) + 1.0 / 12;  // rounding
    EXPECT_NEAR(mean, level * config.white, 5 * std::sqrt(expected / n));
    EXPECT_NEAR(variance, expected, 5 * expected * std::sqrt(2 / n)) << level;
  }
}

TEST(GreyExposure, IsRepeatableSaturatesAndDiffersByFrame) {
  Image<float> light(64, 48, 0.4f);
  light(0, 0) = 9;
  const Image<std::uint8_t> first = expose_grey(light, {}, Seed{1}), again = expose_grey(light, {}, Seed{1});
  const Image<std::uint8_t> other = expose_grey(light, {}, Seed{2});
  EXPECT_EQ(first(0, 0), 255);
  std::size_t same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i], again[i]);
    same += first[i] == other[i];
  }
  EXPECT_LT(same, first.size() / 2);
}

TEST(BadGrey, IsRefused) {
  GreyConfig config;
  EXPECT_NO_THROW(config.validate());
  config.supersampling = 0;
  EXPECT_THROW(config.validate(), SpecError);
  config = {};
  config.blur = -1;
  EXPECT_THROW(config.validate(), SpecError);
  config = {};
  config.full_well = 0;
  EXPECT_THROW(config.validate(), SpecError);
}

}  // namespace
}  // namespace binpick
