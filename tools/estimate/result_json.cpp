#include "tools/estimate/result_json.hpp"

#include <nlohmann/json.hpp>

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

template <class Matrix>
Json row_major(const Matrix& matrix) {
  Json values = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(matrix(r, c));
  return values;
}

const char* name_of(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::kFound:
      return "found";
    case EstimateStatus::kNothingFound:
      return "nothing_found";
    case EstimateStatus::kFailed:
      break;
  }
  return "failed";
}

Json pose_json(const PoseEstimate& e, const std::string& name) {
  Json json;
  json["part"] = e.part;
  json["name"] = name;
  json["score"] = e.score;
  json["ambiguous"] = e.ambiguous;
  json["X_CP"] = row_major(e.X_CP.matrix());
  json["fit_rms"] = e.fit_rms;
  json["inlier_fraction"] = e.inlier_fraction;
  json["covariance"] = row_major(e.covariance);
  return json;
}

}  // namespace

std::string estimates_json(const FrameRequest& request, const std::vector<Part>& parts, const EstimateResult& result) {
  Json json;
  json["schema"] = 1;
  json["status"] = name_of(result.status);
  json["message"] = result.message;
  json["estimator"] = request.estimator_type;
  json["seed"] = request.seed.key;
  json["parts"] = Json::array();
  for (const Part& part : parts) json["parts"].push_back({{"name", part.name}, {"diameter", part.diameter}});
  json["estimates"] = Json::array();
  for (const PoseEstimate& e : result.estimates) json["estimates"].push_back(pose_json(e, parts[e.part].name));
  const StageTimes& wall = result.wall;
  json["wall_s"] = {{"preprocess", wall.preprocess},
                    {"voting", wall.voting},
                    {"verification", wall.verification},
                    {"icp", wall.icp},
                    {"total", wall.total}};
  return json.dump(2) + "\n";
}

}  // namespace binpick
