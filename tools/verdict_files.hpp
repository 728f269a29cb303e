// Where a verdict is written for CI: --junit, --markdown, --json.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/file_io.hpp"
#include "evaluation/comparison.hpp"

namespace binpick {

struct VerdictFiles {
  std::string junit, markdown, json;
};

inline void add_verdict_options(CLI::App& command, VerdictFiles& files) {
  command.add_option("--junit", files.junit, "file for JUnit XML");
  command.add_option("--markdown", files.markdown, "file for Markdown, e.g. a CI summary");
  command.add_option("--json", files.json, "file for the figures");
}

inline void write_verdict(const VerdictFiles& files, const Comparison& comparison) {
  if (!files.junit.empty()) write_file(files.junit, comparison_junit(comparison));
  if (!files.markdown.empty()) write_file(files.markdown, comparison_markdown(comparison));
  if (!files.json.empty()) write_file(files.json, comparison_json(comparison) + "\n");
}

}  // namespace binpick
