#include "evaluation/page_assets.hpp"

#include "evaluation/base64.hpp"

namespace binpick::page {
namespace {

std::string bytes_of_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

}  // namespace

std::string policy_hash(const Asset& asset) { return "'sha256-" + base64(bytes_of_hex(asset.sha256)) + "'"; }

std::string script(const Asset& asset) { return "<script>" + std::string(asset.text) + "</script>\n"; }

std::string style(const Asset& asset) { return "<style>" + std::string(asset.text) + "</style>\n"; }

std::string data_block(const std::string& attributes, const std::string& json) {
  std::string block = "<script type=\"application/json\" " + attributes + ">";
  for (const char c : json) {
    if (c == '<')
      block += "\\u003c";  // no tag, and no end of the block, can stand in it
    else
      block += c;
  }
  return block + "</script>\n";
}

}  // namespace binpick::page
