// Private to evaluation: a rate in JSON, as summary.json, sweep.json and budget.json have it.
#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/summary.hpp"

namespace binpick {

/// `total`, `hits`: the keys of both counts.
inline nlohmann::ordered_json rate_json(const Rate& rate, const char* total, const char* hits) {
  return {{total, rate.total},
          {hits, rate.hits},
          {"rate", rate.rate},
          {"interval", {rate.interval.low, rate.interval.high}}};
}

}  // namespace binpick
