// Every parameter of the pipeline of `type: ppf` and `type: paper_ppf`, one section a stage.
#pragma once

#include "core/config.hpp"
#include "core/error.hpp"
#include "perception/hypothesis_check.hpp"
#include "perception/icp.hpp"
#include "perception/model_cloud.hpp"
#include "perception/preprocess.hpp"
#include "perception/rival_poses.hpp"
#include "perception/view_check.hpp"
#include "perception/voting.hpp"

namespace binpick {

/// How many hypotheses go on from stage to stage.
struct SearchConfig {
  int clusters = 400;             // hypotheses that are verified, the best of each region first
  int refined = 150;              // of those, refined coarsely
  int regional = 10;              // of those, at most so many whose centres lie in one region of half a diameter
  int rounds = 2;                 // the second one looks at what the first left unexplained
  double sure = 0.5;              // fit (quality x share explained) that counts; not the score
  int enough = 0;                 // accepted poses after which the search stops; 0: all that can be found
  double least_coarse = 0;        // score along the rays below which a coarsely refined pose is dropped
  int finished = 50;              // of those, refined finely with the silhouette
  double cluster_distance = 0.1;  // of the diameter
  double cluster_angle = 0.4;     // rad
  bool edges = true;              // vote with oriented edge points, too

  void visit(ConfigVisitor& v) {
    v.field("clusters", clusters, "hypotheses of a part that are verified");
    v.field("refined", refined, "of those, refined coarsely");
    v.field("regional", regional, "of those, at most so many in one region of half a diameter");
    v.field("rounds", rounds, "searches; each further one looks at what is still unexplained");
    v.field("sure", sure, Unit::kNone,
            "inlier quality x explained share of the drawn part from which a pose counts towards enough");
    v.field("enough", enough, "poses that are enough: the search stops early; 0: all that can be found");
    v.field("least_coarse", least_coarse, Unit::kNone, "score that a coarsely refined pose needs, -1 .. 1");
    v.field("finished", finished, "of those, refined finely");
    v.field("cluster_distance", cluster_distance, Unit::kNone, "poses nearer than this are one, of the diameter");
    v.field("cluster_angle", cluster_angle, Unit::kAngle, "and turned by less than this");
    v.field("edges", edges, "vote with pairs of oriented edge points, beside the paper's surface points");
  }
  void validate() const {
    if (clusters < 1 || refined < 1 || regional < 1 || finished < 1 || rounds < 1)
      throw SpecError("search.clusters, refined, regional, finished, rounds: must be at least 1");
    if (!(sure >= 0 && sure <= 1)) throw SpecError("search.sure: must lie between 0 and 1");
    if (!(least_coarse >= -1 && least_coarse < 1)) throw SpecError("search.least_coarse: must lie between -1 and 1");
    if (enough < 0) throw SpecError("search.enough: must not be negative");
    if (!(cluster_distance > 0 && cluster_distance <= 1))
      throw SpecError("search.cluster_distance: must lie between 0 and 1");
    if (!(cluster_angle > 0 && cluster_angle <= 3.2))
      throw SpecError("search.cluster_angle: must lie between 0 and pi");
  }
};

struct PpfSettings {
  ModelCloudConfig model;
  PreprocessConfig preprocess;
  NormalsConfig normals;
  VotingConfig voting;
  SearchConfig search;
  CheckConfig check;
  IcpConfig icp;
  AcceptConfig accept;
  RivalConfig rivals;

  void visit(ConfigVisitor& v) {
    v.section("model", model, "CAD to visible points (paper 2)");
    v.section("preprocess", preprocess, "crop, floor, walls, voxel grid (paper 3.1)");
    v.section("normals", normals, "normals and their agreement (paper eq. 1-3)");
    v.section("voting", voting, "pair features and Hough voting (paper 4, 4.1)");
    v.section("search", search, "how many hypotheses go on");
    v.section("check", check, "hypothesis verification (paper 4.2)");
    v.section("icp", icp, "refinement on visible points (paper 4.2)");
    v.section("accept", accept, "what is returned");
    v.section("rivals", rivals, "poses that the view may not tell apart");
  }
  void validate() const {
    model.validate(), preprocess.validate(), normals.validate(), voting.validate(), search.validate();
    check.validate(), icp.validate(), accept.validate(), rivals.validate();
  }
};

}  // namespace binpick
