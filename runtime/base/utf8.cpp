#include "runtime/base/utf8.h"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "runtime/base/invisible.h"

namespace probe {

Utf8Char first_utf8(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return {first, 1};
  utf8proc_int32_t code = 0;
  const utf8proc_ssize_t bytes =
      utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                       static_cast<utf8proc_ssize_t>(text.size()), &code);
  if (bytes <= 0) return {};
  return {static_cast<char32_t>(code), static_cast<std::size_t>(bytes)};
}

std::size_t find_bad_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    if (static_cast<unsigned char>(text[at]) < 0x80) {
      ++at;
      continue;
    }
    const std::size_t bytes = first_utf8(text.substr(at)).bytes;
    if (bytes == 0) break;
    at += bytes;
  }
  return at;
}

namespace {

// As it is where utf8proc cannot map it.
std::string mapped(std::string_view text, int options) {
  utf8proc_uint8_t* raw = nullptr;
  const utf8proc_ssize_t size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                             static_cast<utf8proc_ssize_t>(text.size()), &raw,
                                             static_cast<utf8proc_option_t>(options));
  const std::unique_ptr<utf8proc_uint8_t, void (*)(void*)> made(raw, std::free);
  if (size < 0) return std::string(text);
  return {reinterpret_cast<const char*>(made.get()), static_cast<std::size_t>(size)};
}

}  // namespace

std::string fold_case(std::string_view text) {
  // Of ASCII the fold is small letters, and nothing composes.
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  if (std::ranges::all_of(text, is_ascii)) {
    std::string out(text);
    for (char& c : out) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return out;
  }
  return mapped(text, UTF8PROC_CASEFOLD | UTF8PROC_COMPOSE | UTF8PROC_STABLE);
}

std::string compatible_form(std::string_view text) {
  constexpr int kForm = UTF8PROC_COMPAT | UTF8PROC_COMPOSE | UTF8PROC_STABLE | UTF8PROC_IGNORE;
  constexpr std::size_t kLongestRun = 64;
  std::string out;
  out.reserve(text.size());
  std::size_t at = 0;
  while (at < text.size()) {
    if (static_cast<unsigned char>(text[at]) < 0x80) {
      out += text[at++];
      continue;
    }
    // Marks may stand on the plain character before.
    std::string run;
    if (at > 0 && static_cast<unsigned char>(text[at - 1]) < 0x80) {
      run = out.back();
      out.pop_back();
    }
    for (std::size_t count = 0; count < kLongestRun && at < text.size(); ++count) {
      if (static_cast<unsigned char>(text[at]) < 0x80) break;
      const Utf8Char character = first_utf8(text.substr(at));
      run += character.bytes == 0 ? std::string_view("\xef\xbf\xbd")
                                  : text.substr(at, character.bytes);
      at += std::max<std::size_t>(character.bytes, 1);
    }
    out += mapped(run, kForm);
  }
  return out;
}

namespace {

// Letters without cases, and the marks upon them: Arabic, Indic scripts and others.
bool is_joined(char32_t code) {
  const auto category = utf8proc_category(static_cast<utf8proc_int32_t>(code));
  return category == UTF8PROC_CATEGORY_LO || category == UTF8PROC_CATEGORY_MN ||
         category == UTF8PROC_CATEGORY_MC;
}

}  // namespace

std::optional<char32_t> find_invisible(std::string_view text) {
  char32_t before = 0;
  while (!text.empty()) {
    const Utf8Char character = first_utf8(text);
    if (character.bytes == 0) return std::nullopt;
    text.remove_prefix(character.bytes);
    const char32_t code = character.code;
    if (is_invisible(code)) return code;
    if (is_joiner(code) &&
        (!is_joined(before) || text.empty() || !is_joined(first_utf8(text).code)))
      return code;
    before = code;
  }
  return std::nullopt;
}

bool is_blank(std::string_view text) {
  while (!text.empty()) {
    const Utf8Char character = first_utf8(text);
    if (character.bytes == 0) return false;
    if (utf8proc_category(static_cast<utf8proc_int32_t>(character.code)) != UTF8PROC_CATEGORY_ZS)
      return false;
    text.remove_prefix(character.bytes);
  }
  return true;
}

}  // namespace probe
