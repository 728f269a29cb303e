// A scene with its cell, through every section's keys and limits. Files that it names are not there; the arm is not
// loaded (target urdf).
#include "core/yaml.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "trials/scenario.hpp"

namespace binpick::fuzz {
namespace {

void validate(const Scenario& s) {
  for (const PartEntry& entry : s.parts) entry.spec.validate();
  s.drop.validate();
  s.settle.validate();
  s.physics.validate();
  s.sensor->validate();
  s.estimator ? s.estimator->validate() : s.oracle.validate();
  s.cell.bin.validate();
  if (s.cell.gripper) s.cell.gripper->validate();
  s.planning.validate();
  s.execution.validate();
  s.second_look.validate();
  s.trial.validate();
}

}  // namespace
}  // namespace binpick::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace binpick;
  const std::string text = fuzz::text_of(data, size);
  Scenario scene;
  const bool good = fuzz::accepts("scene.yaml", [&] {
    read_yaml_text(text, "scene.yaml", "/nowhere", [&](ConfigVisitor& v) {
      scene.visit(v);
      fuzz::validate(scene);
    });
  });
  if (!good) return 0;
  const std::string written = expanded_yaml(scene, "");
  Scenario again;
  read_yaml_text(written, "written.yaml", "/nowhere", [&](ConfigVisitor& v) { again.visit(v); });
  if (expanded_yaml(again, "") != written) fuzz::finding("not the same read back", written);
  return 0;
}
