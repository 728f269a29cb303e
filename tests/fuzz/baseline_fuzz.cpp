// A baseline of the gate. What was accepted is written and read back.
#include "evaluation/pile_figures.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace binpick;
  const std::string text = fuzz::text_of(data, size);
  PileSet set;
  if (!fuzz::accepts("input.jsonl", [&] { set = baseline_from(text, "input.jsonl"); })) return 0;
  const std::string written = baseline_text(set);
  if (baseline_text(baseline_from(written, "written.jsonl")) != written)
    fuzz::finding("not the same read back", written);
  return 0;
}
