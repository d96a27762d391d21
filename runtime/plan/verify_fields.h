// Rules that many records share: strings, slices, references, numbers. Of the verifier's second
// stage only.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>

#include "runtime/base/result.h"
#include "runtime/plan/magnitudes.h"
#include "runtime/plan/tables.h"
#include "runtime/plan/text_rule.h"
#include "runtime/plan/verify_place.h"

namespace probe::plan {

class FieldCheck {
 public:
  FieldCheck(std::span<const std::byte> bytes, const Tables& tables) : place_(bytes), t(tables) {}

 protected:
  Failure fail(Rule rule, const void* at, std::string message) const {
    return place_.fail(rule, at, std::move(message));
  }

  // In range, of good text; `name` must not be empty either.
  Status check_text(const StringRef& ref) const;
  Status check_name(const StringRef& ref, const char* what) const;
  // A name that the language can declare: it stands in paths, columns and groups of results.
  Status check_word(const StringRef& ref, const char* what) const;
  // [first, first + count) inside a table of `size` records.
  Status check_slice(const Slice& slice, std::size_t size, const char* table) const;
  Status check_index(const std::uint32_t& index, std::size_t size, const char* table) const;
  // An asset of that kind, or kNone when `optional`.
  Status check_asset(const std::uint32_t& index, AssetKind kind, bool optional) const;
  Status check_finite(std::span<const double> values) const;
  Status check_unit(std::span<const double> values, const char* what) const;
  Status check_zero(std::span<const std::uint64_t> values) const;
  Status check_zero(const std::uint32_t& value) const;
  // Finite and at least 0, or greater than 0.
  Status check_not_negative(const double& value, const char* what) const;
  Status check_positive(const double& value, const char* what) const;

  // Finite, and as large as magnitudes.def says.
  Status check_magnitude(std::span<const double> values, Magnitude magnitude) const;
  Status check_magnitude(const double& value, Magnitude magnitude) const {
    return check_magnitude({&value, 1}, magnitude);
  }
  // Of what is computed from the field at `place`.
  Status check_magnitude(double value, Magnitude magnitude, const double& place) const;

  // No two records of a table have one name.
  template <typename Record>
  Status check_unique_names(std::span<const Record> table, const char* what) const {
    std::unordered_set<std::string_view> seen;
    seen.reserve(table.size());
    for (const Record& record : table) {
      if (seen.insert(t.text(record.name)).second) continue;
      return fail(Rule::kUniqueName, &record,
                  fmt::format("two {} are called `{}`", what, t.text(record.name)));
    }
    return {};
  }

  Place place_;
  const Tables& t;
};

}  // namespace probe::plan
