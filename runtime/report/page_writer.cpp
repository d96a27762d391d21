#include "runtime/report/page_writer.h"

#include <cstdint>

#include "runtime/report/page_template.h"

namespace probe::report {
namespace {

// Length in bytes of the well-formed UTF-8 sequence at the start of `text`, 0 if there is none
// (Unicode 15, table 3-7: no overlong forms, no surrogates, nothing past U+10FFFF).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
  };
  const auto tail = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return tail(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool second = first == 0xE0   ? byte(1) >= 0xA0 && byte(1) <= 0xBF
                        : first == 0xED ? byte(1) >= 0x80 && byte(1) <= 0x9F
                                        : tail(1);
    return second && tail(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool second = first == 0xF0   ? byte(1) >= 0x90 && byte(1) <= 0xBF
                        : first == 0xF4 ? byte(1) >= 0x80 && byte(1) <= 0x8F
                                        : tail(1);
    return second && tail(2) && tail(3) ? 4 : 0;
  }
  return 0;
}

std::string_view escape_of(std::string_view sequence) {
  if (sequence == "<") return "\\u003c";
  if (sequence == ">") return "\\u003e";
  if (sequence == "&") return "\\u0026";
  if (sequence == "\xE2\x80\xA8") return "\\u2028";
  if (sequence == "\xE2\x80\xA9") return "\\u2029";
  return sequence;
}

void append_document(std::string& page, std::string_view id, std::string_view json) {
  page += "<script type=\"application/json\" id=\"";
  page += id;
  page += "\">";
  page += embeddable(json);
  page += "</script>\n";
}

}  // namespace

std::string embeddable(std::string_view json) {
  std::string text;
  text.reserve(json.size() + json.size() / 16);
  while (!json.empty()) {
    const std::size_t length = sequence_length(json);
    text += length == 0 ? "\\ufffd" : escape_of(json.substr(0, length));
    json.remove_prefix(length == 0 ? 1 : length);
  }
  return text;
}

std::string write_page(const PageDocuments& documents) {
  std::string page;
  for (const std::string_view piece : page_before()) page += piece;
  append_document(page, "data", documents.data);
  append_document(page, "timelines", documents.timelines);
  append_document(page, "whys", documents.whys);
  for (const std::string_view piece : page_after()) page += piece;
  return page;
}

}  // namespace probe::report
