#include "runtime/plan/verify_fields.h"

#include <utf8proc.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "runtime/base/utf8.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {
namespace {

struct Freed {
  void operator()(utf8proc_uint8_t* p) const { std::free(p); }
};

}  // namespace

const char* find_text_defect(std::string_view text) {
  if (std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7f; })) return nullptr;
  const auto* data = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
  const auto size = static_cast<utf8proc_ssize_t>(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Char character = first_utf8(text.substr(at));
    if (character.bytes == 0) return "is not UTF-8";
    if (is_control(character.code)) return "holds a control character";
    at += character.bytes;
  }
  utf8proc_uint8_t* raw = nullptr;
  const utf8proc_ssize_t composed = utf8proc_map(
      data, size, &raw, static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE));
  const std::unique_ptr<utf8proc_uint8_t, Freed> normal(raw);
  if (composed != size || !std::equal(data, data + size, normal.get()))
    return "is not in normal form C";
  return nullptr;
}

Status FieldCheck::check_text(const StringRef& ref) const {
  if (std::uint64_t{ref.offset} + ref.length > t.strings.size()) {
    return fail(Rule::kStringRange, &ref,
                fmt::format("a string at {} of {} bytes ends beyond the {} bytes of STRS",
                            ref.offset, ref.length, t.strings.size()));
  }
  if (ref.length > kMaxStringBytes) {
    return fail(Rule::kStringLength, &ref,
                fmt::format("a string has at most {} bytes, not {}", kMaxStringBytes, ref.length));
  }
  const char* defect = find_text_defect(t.text(ref));
  if (defect != nullptr) return fail(Rule::kStringText, &ref, fmt::format("a string {}", defect));
  return {};
}

Status FieldCheck::check_name(const StringRef& ref, const char* what) const {
  PROBE_TRY(check_text(ref));
  if (ref.length == 0) return fail(Rule::kEmptyName, &ref, fmt::format("{} is not empty", what));
  return {};
}

Status FieldCheck::check_word(const StringRef& ref, const char* what) const {
  PROBE_TRY(check_name(ref, what));
  const std::string_view name = t.text(ref);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_part = [&](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); };
  if (name.size() > kMaxNameBytes) {
    return fail(Rule::kWord, &ref,
                fmt::format("{} has at most {} bytes, not {}", what, kMaxNameBytes, name.size()));
  }
  if (is_letter(name[0]) && std::ranges::all_of(name, is_part)) return {};
  return fail(Rule::kWord, &ref,
              fmt::format("{} is letters, digits and _, a letter first, not `{}`", what, name));
}

Status FieldCheck::check_slice(const Slice& slice, std::size_t size, const char* table) const {
  if (std::uint64_t{slice.first} + slice.count > size) {
    return fail(Rule::kSlice, &slice,
                fmt::format("records {} to {} of {} are named, which has {}", slice.first,
                            std::uint64_t{slice.first} + slice.count, table, size));
  }
  return {};
}

Status FieldCheck::check_index(const std::uint32_t& index, std::size_t size,
                               const char* table) const {
  if (index >= size)
    return fail(Rule::kIndex, &index,
                fmt::format("record {} of {} is named, which has {}", index, table, size));
  return {};
}

Status FieldCheck::check_asset(const std::uint32_t& index, AssetKind kind, bool optional) const {
  if (optional && index == kNone) return {};
  PROBE_TRY(check_index(index, t.assets.size(), "ASST"));
  if (t.assets[index].kind != static_cast<std::uint32_t>(kind)) {
    return fail(Rule::kAssetUse, &index,
                fmt::format("asset {} has kind {}, wanted is {}", index, t.assets[index].kind,
                            static_cast<std::uint32_t>(kind)));
  }
  return {};
}

Status FieldCheck::check_finite(std::span<const double> values) const {
  for (const double& value : values) {
    if (!std::isfinite(value)) return fail(Rule::kFinite, &value, "a real number is finite");
  }
  return {};
}

Status FieldCheck::check_unit(std::span<const double> values, const char* what) const {
  PROBE_TRY(check_finite(values));
  double square = 0;
  for (double value : values) square += value * value;
  if (!(std::fabs(std::sqrt(square) - 1.0) <= 1e-12)) {
    return fail(Rule::kUnit, values.data(),
                fmt::format("{} has length 1 to 1e-12, not {:.17g}", what, std::sqrt(square)));
  }
  return {};
}

Status FieldCheck::check_zero(std::span<const std::uint64_t> values) const {
  for (const std::uint64_t& value : values) {
    if (value != 0) return fail(Rule::kZeros, &value, "reserved bytes are zero");
  }
  return {};
}

Status FieldCheck::check_zero(const std::uint32_t& value) const {
  if (value != 0) return fail(Rule::kZero, &value, "reserved bytes are zero");
  return {};
}

Status FieldCheck::check_not_negative(const double& value, const char* what) const {
  if (std::isfinite(value) && value >= 0) return {};
  return fail(Rule::kNotNegative, &value,
              fmt::format("{} is finite and not negative, not {}", what, value));
}

Status FieldCheck::check_positive(const double& value, const char* what) const {
  if (std::isfinite(value) && value > 0) return {};
  return fail(Rule::kPositive, &value,
              fmt::format("{} is finite and greater than zero, not {}", what, value));
}

Status FieldCheck::check_magnitude(double value, Magnitude magnitude, const double& place) const {
  const MagnitudeInfo& known = info(magnitude);
  if (known.fits(value)) return {};
  return fail(Rule::kMagnitude, &place,
              fmt::format("{} is from {:g} to {:g}{}{}, not {:g}", known.what, known.least,
                          known.most, known.unit.empty() ? "" : " ", known.unit, value));
}

Status FieldCheck::check_magnitude(std::span<const double> values, Magnitude magnitude) const {
  PROBE_TRY(check_finite(values));
  for (const double& value : values) PROBE_TRY(check_magnitude(value, magnitude, value));
  return {};
}

Status RecordCheck::run() const {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) PROBE_TRY(each(t.member));
#include "runtime/plan/sections.def"
  return {};
}

Status verify_tables(std::span<const std::byte> bytes, const Tables& tables) {
  PROBE_TRY(RecordCheck(bytes, tables).run());
  PROBE_TRY(verify_robots(bytes, tables));
  PROBE_TRY(verify_fixtures(bytes, tables));
  PROBE_TRY(verify_variations(bytes, tables));
  PROBE_TRY(verify_relations(bytes, tables));
  PROBE_TRY(verify_skills(bytes, tables));
  PROBE_TRY(verify_claims(bytes, tables));
  PROBE_TRY(verify_later(bytes, tables));
  return verify_questions(bytes, tables);
}

}  // namespace probe::plan
