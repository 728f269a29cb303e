// The page: every failure with its replay command, nothing fetched, no foreign text taken for HTML or script.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/base64.hpp"
#include "evaluation/report.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::campaign;
using testing::HasSubstr;
using testing::Not;

PageSources sources() {
  PageSources made;
  made.picture_paths = {"artifacts/seed-5001/00_depth.png", "artifacts/seed-5001/09_failed.png"};
  made.opening = {{"the heap", "PNG"}};
  made.cell_json = R"({"schema":1})";
  made.replays = {{5001, R"({"schema":1,"seed":"5001"})"}};
  return made;
}

std::string page_of(const std::vector<TrialRecord>& records, const PageSources& made) {
  return html_report(summarise(records, 0), records, made);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

/// The page without the scripts and the style sheet that the program itself carries.
std::string own_part(std::string page) {
  for (const std::string name : {"script", "style"}) {
    const std::string begin = "<" + name + ">", end = "</" + name + ">";
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin))
      page.erase(at, page.find(end, at) + end.size() - at);
  }
  return page;
}

/// The texts of the blocks of data.
std::vector<std::string> data_blocks(const std::string& page) {
  std::vector<std::string> blocks;
  const std::string begin = "<script type=\"application/json\"";
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t text = page.find('>', at) + 1;
    blocks.push_back(page.substr(text, page.find("</script>", text) - text));
  }
  return blocks;
}

TEST(Base64, OfTheStandard) {  // RFC 4648, section 10
  const std::vector<std::pair<std::string, std::string>> cases = {{"", ""},
                                                                  {"f", "Zg=="},
                                                                  {"fo", "Zm8="},
                                                                  {"foo", "Zm9v"},
                                                                  {"foob", "Zm9vYg=="},
                                                                  {"fooba", "Zm9vYmE="},
                                                                  {"foobar", "Zm9vYmFy"},
                                                                  {std::string("\0\xff", 2), "AP8="}};
  for (const auto& [bytes, text] : cases) EXPECT_EQ(base64(bytes), text);
}

TEST(HtmlReport, EveryFailureHasItsReplay) {
  const std::string page = page_of(campaign(), sources());
  EXPECT_THAT(page, HasSubstr("<td>binpick trial scenario.yaml --seed 5001</td>"));
  EXPECT_THAT(page, HasSubstr("<td>5001</td><td class=\"n\">9</td><td>NoSeal</td><td>as the test says</td>"));
  EXPECT_EQ(count(own_part(page), "<td>binpick trial scenario.yaml --seed"), 1u);
  EXPECT_THAT(page, HasSubstr("href=\"artifacts/seed-5001/09_failed.png\""));
  EXPECT_THAT(page, HasSubstr("95.0 % of 20 parts cleared"));
  EXPECT_THAT(page, HasSubstr("<td>rim blocked</td><td class=\"n\">60</td>"));  // 3 in each of 20 picks
  EXPECT_THAT(page, HasSubstr("<option value=\"5001\">"));
}

TEST(HtmlReport, AsksNobodyForAnything) {
  const std::string page = own_part(page_of(campaign(), sources()));
  EXPECT_THAT(page,
              HasSubstr("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-"));
  EXPECT_THAT(page, HasSubstr("img-src data:;"));
  for (const char* forbidden :
       {"http:", "https:", "<link", "@import", "url(", "unsafe-", " style=", "<iframe", "<object", "onclick"})
    EXPECT_THAT(page, Not(HasSubstr(forbidden)));
  EXPECT_EQ(count(page, "src=\""), count(page, "src=\"data:image/png;base64,"));
  EXPECT_EQ(count(page, "<script"), count(page, "<script type=\"application/json\""));
}

TEST(HtmlReport, DataBlocksHoldJsonAndNoTag) {
  std::vector<TrialRecord> records = campaign();
  records[1].picks[9].reason = "</script><script>alert(1)</script><!--";
  const std::vector<std::string> blocks = data_blocks(page_of(records, sources()));
  ASSERT_EQ(blocks.size(), 3u);
  for (const std::string& block : blocks) {
    EXPECT_EQ(block.find('<'), std::string::npos);
    EXPECT_TRUE(nlohmann::json::accept(block)) << block;
  }
  const nlohmann::json tables = nlohmann::json::parse(blocks[0]);
  EXPECT_EQ(tables["schema"], 1);
  for (const auto& table : tables["tables"]) {
    if (table["id"] != "failures") continue;
    EXPECT_EQ(table["rows"][0][3], records[1].picks[9].reason);
  }
}

TEST(HtmlReport, HostileStringsAreEscaped) {
  const std::string attack = "\"><script>alert('x')</script><img src=x onerror=alert(1)>&";
  std::vector<TrialRecord> records = campaign();
  for (TrialRecord& record : records) {
    record.scenario = record.scenario_hash = record.build = attack;
    for (PickRecord& p : record.picks) {
      p.reason = attack;
      p.rejections = {{attack, 1}};
    }
  }
  PageSources made = sources();
  made.picture_paths = {"artifacts/" + attack + "/a.png",
                        "artifacts/seed-5001/" + attack,
                        attack + "heap.png",
                        "../secret.png",
                        "/etc/secret.png",
                        "javascript:alert(1)",
                        "a/../../secret"};
  made.opening = {{attack, "PNG"}};
  made.provenance = {{attack, attack}};
  made.replay_note = attack;
  const std::string page = own_part(page_of(records, made));
  EXPECT_EQ(count(page, "<script"), count(page, "<script type=\"application/json\""));
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
  EXPECT_THAT(page, Not(HasSubstr("href=\"javascript:")));
  EXPECT_THAT(page, HasSubstr("&quot;&gt;&lt;script&gt;alert(&#39;x&#39;)"));
  // Whatever stands between < and > is one of our own tags: its quotes are paired, and no attribute has been smuggled
  // in.
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const std::string tag = page.substr(at, page.find('>', at) - at);
    EXPECT_EQ(count(tag, "\"") % 2, 0u) << tag;
    EXPECT_EQ(count(tag, "<"), 1u) << tag;
    EXPECT_THAT(tag, Not(HasSubstr("onerror=\""))) << tag;
  }
}

TEST(HtmlReport, EmptyCampaign) {
  const std::string page = own_part(page_of({}, {}));
  EXPECT_EQ(count(page, "nothing to judge"), 1u);
  for (const char* none : {">nan", ">-nan", "\"nan", " nan", "undefined"}) EXPECT_EQ(count(page, none), 0u) << none;
  EXPECT_THAT(page, Not(HasSubstr("id=\"viewer\"")));
}

TEST(HtmlReport, WithoutReplaysItCarriesNoViewer) {
  const std::string with = page_of(campaign(), sources()), without = page_of(campaign(), {});
  EXPECT_THAT(without, Not(HasSubstr("id=\"viewer\"")));
  EXPECT_GT(with.size(), without.size() + 800'000);  // three.js
}

}  // namespace
}  // namespace binpick
