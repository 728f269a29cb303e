// A baseline file: {"binpick_baseline":1,"scenario":..,"scenario_hash":..,"record_schema":..,"piles":n}, then one line
// per seed.
#include "evaluation/json_archive.hpp"
#include "evaluation/pile_figures.hpp"

namespace binpick {
namespace {

constexpr int kBaselineFormat = 1;

template <class Archive, class Count>
void count_fields(Archive& archive, const char* key, Count& count) {
  std::vector<double> pair = {count.hits, count.total};
  archive(key, pair);
  if constexpr (!std::is_const_v<Count>) {
    if (pair.size() != 2 || !(pair[0] >= 0 && pair[0] <= pair[1])) archive.fail(key, "is not [hits, total]");
    count = {pair[0], pair[1]};
  }
}

template <class Archive, class Pile>
void pile_fields(Archive& archive, Pile& pile) {
  archive("seed", pile.seed);
  archive("crashed", pile.crashed);
  archive.hash("heap", pile.heap_hash);
  archive.list("turns", pile.turns, [](auto& inner, auto& turn) {
    inner.hash("frame", turn.frame);
    inner.hash("estimates", turn.estimates);
    inner.hash("world", turn.world);
  });
  archive.hash("content", pile.content_hash);
  count_fields(archive, "picks", pile.picks);
  count_fields(archive, "cleared", pile.cleared);
  count_fields(archive, "recall", pile.recall);
  count_fields(archive, "recall_first_look", pile.recall_first_look);
  count_fields(archive, "precision", pile.precision);
  archive("first_pick", pile.first_pick);
  archive("missed", pile.missed);
  archive("translations", pile.translations);
  archive("rotations", pile.rotations);
  archive("cycles", pile.cycles);
}

template <class Archive, class Set, class Number>
void header_fields(Archive& archive, Set& set, Number& piles) {
  archive("scenario", set.scenario);
  archive("scenario_hash", set.scenario_hash);
  archive("record_schema", set.record_schema);
  archive("piles", piles);
}

std::string line_at(const std::string& text, std::size_t& begin, const std::string& place) {
  const std::size_t end = text.find('\n', begin);
  if (end == std::string::npos) throw SpecError(place + ": the file is cut off");
  const std::string line = text.substr(begin, end - begin);
  begin = end + 1;
  return line;
}

std::size_t read_header(const std::string& line, const std::string& place, PileSet& set) {
  const nlohmann::json json = parsed_line(line, place);
  JsonReader reader(json, place + ": ");
  int format = 0;
  reader("binpick_baseline", format);
  if (format != kBaselineFormat) {
    reader.fail("binpick_baseline",
                std::to_string(format) + " is not " + std::to_string(kBaselineFormat) + ", which is read here");
  }
  std::uint64_t piles = 0;
  header_fields(reader, set, piles);
  reader.finish();
  return piles;
}

}  // namespace

std::string baseline_text(const PileSet& set) {
  JsonWriter header;
  const int format = kBaselineFormat;
  const std::uint64_t piles = set.piles.size();
  header("binpick_baseline", format);
  header_fields(header, set, piles);
  std::string text = dumped(header.json) + "\n";
  for (const PileFigures& pile : set.piles) {
    JsonWriter line;
    pile_fields(line, pile);
    text += dumped(line.json) + "\n";
  }
  return text;
}

PileSet baseline_from(const std::string& text, const std::string& path) {
  PileSet set;
  set.name = path;
  std::size_t begin = 0, number = 1;
  std::string place = path + ":1";
  const std::size_t piles = read_header(line_at(text, begin, place), place, set);
  while (begin < text.size()) {
    place = path + ":" + std::to_string(++number);
    const nlohmann::json json = parsed_line(line_at(text, begin, place), place);
    JsonReader reader(json, place + ": ");
    PileFigures pile;
    pile_fields(reader, pile);
    reader.finish();
    if (!set.piles.empty() && pile.seed <= set.piles.back().seed) reader.fail("seed", "does not ascend");
    set.piles.push_back(std::move(pile));
  }
  if (set.piles.size() != piles || piles == 0) {
    throw SpecError(path + ": holds " + std::to_string(set.piles.size()) + " piles, its first line says " +
                    std::to_string(piles));
  }
  return set;
}

}  // namespace binpick
