// Strict YAML through three small configurations: a part, a bin, the margins of the gate.
#include "core/bin_spec.hpp"
#include "core/part.hpp"
#include "core/yaml.hpp"
#include "evaluation/gate_rules.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace binpick::fuzz {
namespace {

/// What was accepted is written and read back to the same text.
template <class Config>
void read(const std::string& text) {
  Config config;
  const auto visit = [&](ConfigVisitor& v) { config.visit(v); };
  const bool good = accepts("input.yaml", [&] {
    read_yaml_text(text, "input.yaml", "/nowhere", [&](ConfigVisitor& v) {
      config.visit(v);
      config.validate();
    });
  });
  if (!good) return;
  const std::string written = write_yaml(visit);
  Config again;
  read_yaml_text(written, "written.yaml", "/nowhere", [&](ConfigVisitor& v) { again.visit(v); });
  if (write_yaml([&](ConfigVisitor& v) { again.visit(v); }) != written) finding("not the same read back", written);
}

}  // namespace
}  // namespace binpick::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = binpick::fuzz::text_of(data, size);
  binpick::fuzz::read<binpick::PartSpec>(text);
  binpick::fuzz::read<binpick::BinSpec>(text);
  binpick::fuzz::read<binpick::GateRules>(text);
  return 0;
}
