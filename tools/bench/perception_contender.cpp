#include "tools/bench/perception_contender.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "evaluation/statistics.hpp"
#include "perception/ppf_pipeline.hpp"
#include "tools/bench/peers/peer.hpp"

namespace binpick {
namespace {

constexpr int kTrainings = 3;
constexpr double kLongTraining = 2000;  // ms: not repeated

/// "a.b.c=v" as the YAML {a: {b: {c: v}}}.
std::string nested_yaml(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw SpecError("--set " + setting + ": expected key=value, sections separated by dots");
  std::string open, close, key = setting.substr(0, equals);
  for (std::size_t dot; (dot = key.find('.')) != std::string::npos; key = key.substr(dot + 1)) {
    open += "{" + key.substr(0, dot) + ": ";
    close += "}";
  }
  return open + "{" + key + ": " + setting.substr(equals + 1) + "}" + close;
}

void set(const std::string& setting, const std::function<void(ConfigVisitor&)>& body) {
  read_yaml_text(nested_yaml(setting), "--set " + setting, "", body);
}

/// True when the estimator has such a setting and takes it.
bool apply_if_known(const std::string& setting, PoseEstimator& estimator) {
  try {
    set(setting, [&](ConfigVisitor& v) { estimator.visit(v); });
    return true;
  } catch (const SpecError&) {
    return false;
  }
}

bool is_peer_name(const std::string& type) {
  const std::vector<EstimatorEntry>& peers = peer_registry();
  return std::any_of(peers.begin(), peers.end(), [&](const EstimatorEntry& peer) { return peer.name == type; });
}

std::unique_ptr<PoseEstimator> make_any(const std::string& type) {
  for (const EstimatorEntry& peer : peer_registry())
    if (peer.name == type) return peer.make();
  return make_estimator(type);
}

/// The type and the settings of a scene's `estimator:` section, kept in a file of its own.
struct FileSection {
  std::string type = "ppf";
  std::unique_ptr<PoseEstimator> estimator;
  OracleConfig oracle;
  void visit(ConfigVisitor& v) {
    v.field("type", type, "estimator");
    if (type == "oracle") return oracle.visit(v);
    if (!estimator) estimator = make_any(type);
    estimator->visit(v);
  }
};

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Never with what the disk holds, unless told: another build may have put it there.
void prepare_with(PoseEstimator& estimator, std::span<const Part> parts, const DiskCache& cache) {
  auto* ppf = dynamic_cast<PpfEstimator*>(&estimator);
  ppf ? ppf->prepare_with(parts, cache) : estimator.prepare(parts);
}

/// Median of several preparations of one part.
double preparation_ms(PoseEstimator& estimator, std::span<const Part> part, const DiskCache& cache) {
  std::vector<double> times;
  while (times.empty() || (times.size() < kTrainings && times.front() < kLongTraining)) {
    const auto start = std::chrono::steady_clock::now();
    prepare_with(estimator, part, cache);
    times.push_back(milliseconds_since(start));
  }
  return quantile(times, 0.5);
}

/// The same from a cache of its own, filled before.
double load_ms(PoseEstimator& estimator, std::span<const Part> part) {
  if (!dynamic_cast<PpfEstimator*>(&estimator)) return 0;
  std::string folder = (std::filesystem::temp_directory_path() / "binpick_bench_XXXXXX").string();
  if (!::mkdtemp(folder.data())) return 0;
  const DiskCache cache(folder);
  prepare_with(estimator, part, cache);
  const double ms = preparation_ms(estimator, part, cache);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return ms;
}

/// An estimator or (null) the oracle, with everything that the specification says.
std::unique_ptr<PoseEstimator> configured(const ContenderSpec& spec, std::string& type, OracleConfig& oracle) {
  FileSection section;
  section.type = spec.type;
  if (!spec.file.empty()) read_yaml_file(spec.file, [&](ConfigVisitor& v) { section.visit(v); });
  if (section.type != "oracle" && !section.estimator) section.estimator = make_any(section.type);
  PoseEstimator* estimator = section.estimator.get();
  for (const std::string& setting : spec.settings)
    set(setting, [&](ConfigVisitor& v) { estimator ? estimator->visit(v) : section.oracle.visit(v); });
  estimator ? estimator->validate() : section.oracle.validate();
  oracle = section.oracle;
  type = section.type;
  return std::move(section.estimator);
}

}  // namespace

ContenderSpec parse_contender(const std::string& text) {
  std::istringstream words(text);
  ContenderSpec spec;
  spec.name = text;
  if (!(words >> spec.type)) throw SpecError("--estimator: expected a type, as in 'ppf' or 'ppf search.edges=false'");
  for (std::string word; words >> word;) spec.settings.push_back(word);
  return spec;
}

Contender::Contender(const ContenderSpec& spec) : name_(spec.name) {
  estimator_ = configured(spec, type_, oracle_);
  peer_ = is_peer_name(type_);
  if (name_.empty()) name_ = spec.file.empty() ? spec.type : spec.file;
  if (!estimator_) return;
  OracleConfig unused;
  std::unique_ptr<PoseEstimator> first = configured(spec, type_, unused);
  if (apply_if_known("search.enough=1", *first)) first_ = std::move(first);
}

std::string Contender::settings() const {
  return write_yaml([this](ConfigVisitor& v) {
    if (estimator_) return estimator_->visit(v);
    OracleConfig copy = oracle_;
    copy.visit(v);
  });
}

std::vector<Training> Contender::prepare(std::span<const Part> parts) {
  parts_.assign(parts.begin(), parts.end());
  std::vector<Training> trained(parts.size());
  if (!estimator_) return trained;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double loading = load_ms(*estimator_, parts.subspan(p, 1));
    const double training = preparation_ms(*estimator_, parts.subspan(p, 1), DiskCache(""));
    trained[p] = {training, loading, estimator_->table_bytes()};
  }
  if (parts.size() > 1) prepare_with(*estimator_, parts, DiskCache(""));
  if (first_) prepare_with(*first_, parts, DiskCache(""));
  return trained;
}

EstimateResult Contender::estimate(const Observation& seen, Seed seed, std::vector<ScoreFeatures>* features) const {
  if (!estimator_) return oracle_estimate(seen.truth, parts_, oracle_, seed);
  const auto* ppf = features ? dynamic_cast<const PpfEstimator*>(estimator_.get()) : nullptr;
  return ppf ? ppf->estimate_with(seen.view, features) : estimator_->estimate(seen.view, seed);
}

EstimateResult Contender::estimate_first(const Observation& seen, Seed seed) const {
  return first_->estimate(seen.view, seed);
}

}  // namespace binpick
