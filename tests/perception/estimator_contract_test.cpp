// The contract of the pose estimators, over the registry.
#include "tests/perception/estimator_contract.hpp"

namespace binpick {
namespace {

/// All but `external`, which is held to it where there is a program to run (tests/tools).
std::vector<ContractCase> cases() {
  std::vector<ContractCase> all;
  for (const std::string& name : estimator_names())
    if (name != "external") all.push_back({name, ""});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Registry, EstimatorContract, ::testing::ValuesIn(cases()),
                         [](const auto& held) { return held.param.name; });

TEST(EstimatorRegistry, NamesTheNearestOfAMisspeltType) {
  try {
    make_estimator("paper_pfp");
    FAIL();
  } catch (const SpecError& e) {
    EXPECT_NE(std::string(e.what()).find("'paper_ppf'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace binpick
