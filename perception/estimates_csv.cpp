#include "perception/estimates_csv.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "core/quantity.hpp"
#include "perception/score_calibration.hpp"
#include "perception/symmetry_covariance.hpp"

namespace binpick {
namespace {

constexpr std::size_t kLargestFile = std::size_t{16} << 20;
constexpr std::size_t kMostPoses = 10000;
constexpr double kRotationError = 1e-3;  // of R'R from the identity: six digits are enough, garbage is not
constexpr double kFarthest = 100;        // m
constexpr double kSigmaT = 0.002;        // m and rad, where the table states none
constexpr double kSigmaR = 0.05;

enum Column {
  kPart,
  kScore,
  kR,
  kT = kR + 9,
  kRms = kT + 3,
  kInliers,
  kAmbiguous,
  kSigmaTColumn,
  kSigmaRColumn,
  kColumns
};
constexpr const char* kNames[kColumns] = {
    "part",      "score",   "r11",    "r12", "r13", "r21", "r22",     "r23",
    "r31",       "r32",     "r33",    "tx",  "ty",  "tz",  "fit_rms", "inlier_fraction",
    "ambiguous", "sigma_t", "sigma_r"};
constexpr int kNeeded = kRms;

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> items(1);
  for (const char c : line) {
    if (c == at)
      items.emplace_back();
    else if (c != '\r' && c != ' ')
      items.back() += c;
  }
  return items;
}

class Table {
 public:
  Table(std::string path, std::span<const Part> parts) : path_(std::move(path)), parts_(parts) {}

  std::vector<PoseEstimate> read() {
    std::vector<std::string> lines = split_lines(read_file(path_, kLargestFile));
    while (!lines.empty() && lines.back().find_first_not_of(" \r") == std::string::npos) lines.pop_back();
    if (lines.empty()) fail("is empty; a table without poses still has its line of column names");
    read_header(lines[0]);
    if (lines.size() - 1 > kMostPoses) fail("more than " + std::to_string(kMostPoses) + " poses");
    std::vector<PoseEstimate> estimates;
    for (line_ = 2; line_ <= lines.size(); ++line_) estimates.push_back(read_row(lines[line_ - 1]));
    std::stable_sort(estimates.begin(), estimates.end(),
                     [](const PoseEstimate& a, const PoseEstimate& b) { return a.score > b.score; });
    return estimates;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw AssetError(one_line(path_ + (line_ > 0 ? ":" + std::to_string(line_) : "") + ": " + message));
  }

  static std::vector<std::string> split_lines(const std::string& text) {
    std::vector<std::string> lines(1);
    for (const char c : text) c == '\n' ? void(lines.emplace_back()) : lines.back().push_back(c);
    return lines;
  }

  void read_header(const std::string& line) {
    line_ = 1;
    header_ = split(line, ',');
    for (const std::string& name : header_) {
      const auto known = std::find(std::begin(kNames), std::end(kNames), name);
      if (known == std::end(kNames)) fail("'" + name.substr(0, 40) + "' is not a column of the protocol");
      if (std::count(header_.begin(), header_.end(), name) > 1) fail("column " + name + " stands twice");
      columns_.push_back(static_cast<int>(known - std::begin(kNames)));
    }
    for (int k = 0; k < kNeeded; ++k)
      if (std::find(columns_.begin(), columns_.end(), k) == columns_.end())
        fail(std::string("column ") + kNames[k] + " is missing");
  }

  double number(const std::string& text, int column) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(std::string(kNames[column]) + ": '" + text.substr(0, 40) + "' is not a finite number");
    return value;
  }

  PoseEstimate read_row(const std::string& line) const {
    const std::vector<std::string> cells = split(line, ',');
    if (cells.size() != columns_.size())
      fail("has " + std::to_string(cells.size()) + " values for " + std::to_string(columns_.size()) + " columns");
    double values[kColumns] = {};
    values[kSigmaTColumn] = kSigmaT;
    values[kSigmaRColumn] = kSigmaR;
    for (std::size_t k = 0; k < cells.size(); ++k) values[columns_[k]] = number(cells[k], columns_[k]);
    return estimate_of(values);
  }

  PoseEstimate estimate_of(const double* values) const {
    PoseEstimate e;
    const double part = values[kPart];
    if (!(part >= 0 && part < static_cast<double>(parts_.size()) && part == std::floor(part)))
      fail("part " + format_double(part) + " is none of the " + std::to_string(parts_.size()) + " parts");
    e.part = static_cast<std::size_t>(part);
    e.score = values[kScore];
    if (!(e.score >= 0 && e.score <= 1)) fail("score " + format_double(e.score) + " must lie in 0 .. 1");
    e.X_CP = rigid(values);
    e.fit_rms = values[kRms];
    e.inlier_fraction = values[kInliers];
    if (!(e.fit_rms >= 0)) fail("fit_rms must not be negative");
    if (!(e.inlier_fraction >= 0 && e.inlier_fraction <= 1)) fail("inlier_fraction must lie in 0 .. 1");
    if (values[kAmbiguous] != 0 && values[kAmbiguous] != 1) fail("ambiguous must be 0 or 1");
    e.ambiguous = values[kAmbiguous] == 1;
    const double sigma_t = values[kSigmaTColumn], sigma_r = values[kSigmaRColumn];
    if (!(sigma_t > 0 && sigma_r > 0)) fail("sigma_t and sigma_r must be positive");
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(sigma_t * sigma_t), Eigen::Vector3d::Constant(sigma_r * sigma_r);
    e.covariance = Matrix6d(variances.asDiagonal()) + unknowable(symmetry_twists(parts_[e.part].symmetry));
    return e;
  }

  Pose rigid(const double* values) const {
    Eigen::Matrix3d R;
    for (int k = 0; k < 9; ++k) R(k / 3, k % 3) = values[kR + k];
    if (!((R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationError) || R.determinant() < 0)
      fail("r11 .. r33 are not a rotation");
    const Eigen::Vector3d t(values[kT], values[kT + 1], values[kT + 2]);
    if (t.cwiseAbs().maxCoeff() > kFarthest) fail("a translation beyond 100 m; it is in metres");
    // The nearest rotation: what the digits left off is put right.
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const bool exact = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-12;
    return pose_from(exact ? R : Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()), t);
  }

  std::string path_;
  std::span<const Part> parts_;
  std::vector<std::string> header_;
  std::vector<int> columns_;
  std::size_t line_ = 0;
};

}  // namespace

std::string estimates_csv(const EstimateResult& result) {
  std::string text = "part,score,fit_rms,inlier_fraction,r11,r12,r13,r21,r22,r23,r31,r32,r33,tx,ty,tz\n";
  for (const PoseEstimate& e : result.estimates) {
    text += std::to_string(e.part);
    for (const double value : {e.score, e.fit_rms, e.inlier_fraction}) text += "," + format_double(value);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) text += "," + format_double(e.X_CP.linear()(r, c));
    for (int i = 0; i < 3; ++i) text += "," + format_double(e.X_CP.translation()[i]);
    text += "\n";
  }
  return text;
}

std::vector<PoseEstimate> read_estimates_csv(const std::string& path, std::span<const Part> parts) {
  return Table(path, parts).read();
}

}  // namespace binpick
