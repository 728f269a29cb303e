// The skeleton of a page: policy, style, scripts, data. Private to this folder.
#pragma once

#include <string>

#include "evaluation/report.hpp"

namespace binpick::html {

struct Page {
  std::string title;        ///< not yet escaped
  std::string body;         ///< HTML
  std::string tables_json;  ///< for the plots; empty: a page without them
  const PageSources* sources = nullptr;
};

std::string whole_page(const Page& page);

/// Embedded, each with its caption.
std::string figures(const std::vector<PageSources::Picture>& pictures);

/// The replay viewer's place in the page; nothing where there are no replays.
std::string replay_section(const PageSources& sources);

}  // namespace binpick::html
