#include "tools/bench/perception_ablation.hpp"

namespace binpick {

std::vector<ContenderSpec> ablation_variants() {
  struct Variant {
    const char *name, *type;
    std::vector<std::string> settings;
  };
  const Variant variants[] = {
      {"ppf, all steps", "ppf", {}},
      {"without edge votes", "ppf", {"search.edges=false"}},
      {"without floor calibration", "ppf", {"preprocess.calibrate_floor=false"}},
      {"thin parts not told from the floor", "ppf", {"preprocess.thin_parts=false"}},
      {"without silhouette in the ICP", "ppf", {"icp.silhouette=false"}},
      {"one search round", "ppf", {"search.rounds=1"}},
      {"table cells over 300 skipped", "ppf", {"voting.largest_cell=300"}},
      {"one peak a reference", "ppf", {"voting.peaks=1"}},
      {"paper's pair radius (half the diameter)", "ppf", {"voting.pair_radius=0.5"}},
      {"without a quota for each region", "ppf", {"search.regional=1000000"}},
      {"fixed tolerances, not the sensor's sigma", "ppf", {"check.tolerance_sigmas=0", "icp.accept_sigmas=0"}},
      {"without the leak test", "ppf", {"accept.largest_leak=1"}},
      {"unlikely poses returned, too", "ppf", {"accept.least_score=0"}},
      {"without ownership of pixels", "ppf", {"accept.least_own=0"}},
      {"without the test of rivals", "ppf", {"rivals.least_alike=1"}},
      {"without the overlap test", "ppf", {"accept.largest_overlap=1"}},
      {"paper_ppf", "paper_ppf", {}},
  };
  std::vector<ContenderSpec> specs;
  for (const Variant& v : variants) specs.push_back({v.name, v.type, v.settings, ""});
  return specs;
}

}  // namespace binpick
