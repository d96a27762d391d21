#include "runtime/report/page_writer.h"

#include "runtime/base/utf8.h"
#include "runtime/report/page_template.h"

namespace probe::report {
namespace {

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
    const std::size_t length = first_utf8(json).bytes;
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
