// What a report page carries: the packaged Chart.js and three.js, our scripts and the style sheet, embedded when the
// program is built. Private to this folder.
#pragma once

#include <string>
#include <string_view>

namespace binpick::page {

struct Asset {
  std::string_view text;
  std::string_view sha256;  ///< of the text, hexadecimal: what the page's policy allows to run
};

Asset chart_js();
Asset three_js();
Asset orbit_controls_js();
Asset report_js();
Asset replay_js();
Asset report_css();

/// 'sha256-...' as a content-security policy names it.
std::string policy_hash(const Asset& asset);
/// <script>..</script> and <style>..</style>, byte for byte as hashed.
std::string script(const Asset& asset);
std::string style(const Asset& asset);
/// JSON text as a block that no browser runs; `attributes` are escaped already.
std::string data_block(const std::string& attributes, const std::string& json);

}  // namespace binpick::page
