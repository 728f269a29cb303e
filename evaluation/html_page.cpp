#include "evaluation/html_page.hpp"

#include "evaluation/base64.hpp"
#include "evaluation/page_assets.hpp"
#include "evaluation/report_text.hpp"

namespace binpick::html {
namespace {

// Nothing is fetched; only the scripts and the style sheet that the program carries take effect.
std::string policy() {
  std::string scripts;
  for (const page::Asset& asset :
       {page::chart_js(), page::three_js(), page::orbit_controls_js(), page::report_js(), page::replay_js()})
    scripts += " " + page::policy_hash(asset);
  return "default-src 'none'; script-src" + scripts + "; style-src " + page::policy_hash(page::report_css()) +
         "; img-src data:; base-uri 'none'; form-action 'none'";
}

std::string replay_blocks(const PageSources& sources) {
  if (sources.replays.empty()) return "";
  std::string blocks = page::data_block("id=\"replay-cell\"", sources.cell_json);
  for (const PageSources::Replay& replay : sources.replays)
    blocks += page::data_block("class=\"replay-data\" data-seed=\"" + std::to_string(replay.seed) + "\"", replay.json);
  return blocks;
}

}  // namespace

std::string figures(const std::vector<PageSources::Picture>& pictures) {
  std::string html;
  for (const PageSources::Picture& picture : pictures) {
    const std::string caption = text::html(picture.caption);
    html += "<figure><img src=\"data:image/png;base64," + base64(picture.png) + "\" alt=\"" + caption +
            "\"><figcaption>" + caption + "</figcaption></figure>";
  }
  return html;
}

std::string replay_section(const PageSources& sources) {
  if (sources.replays.empty()) return "";
  std::string options;
  for (const PageSources::Replay& replay : sources.replays)
    options +=
        "<option value=\"" + std::to_string(replay.seed) + "\">seed " + std::to_string(replay.seed) + "</option>";
  return "<section id=\"replay\"><h2>Replay</h2><div class=\"viewer\" id=\"viewer\">"
         "<div class=\"row\"><label>Trial <select id=\"replay-seed\">" +
         options +
         "</select></label><span id=\"replay-status\" role=\"status\"></span></div>"
         "<div class=\"stage\"><div id=\"replay-canvas\" tabindex=\"0\" role=\"application\" aria-label=\"3D replay; "
         "space plays, arrows step, brackets go from pick to pick\"></div><div id=\"replay-side\"></div></div>"
         "<div id=\"replay-controls\"></div><noscript><p>The replay needs scripts; what happened stands in the tables "
         "below.</p></noscript></div>" +
         (sources.replay_note.empty() ? "" : "<p class=\"note\">" + text::html(sources.replay_note) + "</p>") +
         "</section>";
}

std::string whole_page(const Page& page) {
  const PageSources& sources = *page.sources;
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      policy() + "\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
      text::html(page.title) + " - binpick</title>\n" + page::style(page::report_css()) + "</head><body><main>" +
      page.body + "</main>\n";
  if (!page.tables_json.empty())
    html += page::data_block("id=\"report-tables\"", page.tables_json) + page::script(page::chart_js()) +
            page::script(page::report_js());
  html += replay_blocks(sources);
  if (!sources.replays.empty())
    html += page::script(page::three_js()) + page::script(page::orbit_controls_js()) + page::script(page::replay_js());
  return html + "</body></html>\n";
}

}  // namespace binpick::html
