#include "runtime/export/parquet/rows.h"

#include <array>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#include "runtime/base/check.h"

namespace probe::parquet {
namespace {

template <typename T>
void append(std::vector<std::uint8_t>& to, T value) {
  std::array<std::uint8_t, sizeof value> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

void append_text(std::vector<std::uint8_t>& to, std::string_view text) {
  append(to, static_cast<std::uint32_t>(text.size()));
  to.insert(to.end(), text.begin(), text.end());
}

void add_level(std::vector<Gathered::Run>& runs, int level, std::size_t times = 1) {
  const auto wanted = static_cast<std::uint8_t>(level);
  if (times == 0) return;
  if (runs.empty() || runs.back().level != wanted) runs.push_back({wanted, 0});
  runs.back().times += times;
}

}  // namespace

Rows::Rows(Schema schema) : schema_(std::move(schema)), columns_(schema_.size()) {
  for (const Column& column : schema_)
    PROBE_CHECK(column.depth >= 0 && column.depth <= kMostDepth, "a column's lists are too deep");
}

Gathered& Rows::next(Type type, int depth) {
  PROBE_CHECK(at_ < schema_.size(), "a table without columns has no rows");
  const Column& column = schema_[at_];
  const bool fits = column.type == type || (type == Type::kReal64 && column.type == Type::kReal32);
  PROBE_CHECK(fits && column.depth == depth, "a value is of another type than its column");
  return columns_[at_];
}

void Rows::end_value() {
  if (++at_ < schema_.size()) return;
  at_ = 0;
  ++count_;
}

void Rows::put_real(Gathered& to, Type type, double value) {
  if (type == Type::kReal32) return append(to.values, static_cast<float>(value));
  append(to.values, value);
}

// The level of repetition says at which depth a list goes on: 0 begins a row, the column's depth
// goes on in the innermost list.
void Rows::put_shape(Gathered& to, const Column& column, std::span<const std::size_t> shape) {
  const std::size_t count =
      std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  if (count == 0) {
    PROBE_CHECK(shape.size() == 1, "only a list of values can be empty");
    add_level(to.definitions, 1);
    add_level(to.repetitions, 0);
    ++to.count;
    return;
  }
  add_level(to.definitions, definition_of(column), count);
  for (std::size_t i = 0; i < count; ++i) {
    int level = i == 0 ? 0 : column.depth;
    for (std::size_t side = shape.size(), rest = i; i > 0 && side-- > 0; rest /= shape[side]) {
      if (rest % shape[side] != 0) break;
      --level;
    }
    add_level(to.repetitions, level);
  }
  to.count += count;
}

Rows& Rows::end_one(Gathered& to) {
  add_level(to.definitions, 1);
  ++to.count;
  end_value();
  return *this;
}

Rows& Rows::flag(bool value) {
  Gathered& to = next(Type::kFlag, 0);
  to.values.push_back(value ? 1 : 0);
  return end_one(to);
}

Rows& Rows::whole(std::int64_t value) {
  Gathered& to = next(Type::kWhole, 0);
  append(to.values, value);
  return end_one(to);
}

Rows& Rows::real(double value) {
  Gathered& to = next(Type::kReal64, 0);
  put_real(to, schema_[at_].type, value);
  return end_one(to);
}

Rows& Rows::text(std::string_view value) {
  Gathered& to = next(Type::kText, 0);
  append_text(to.values, value);
  return end_one(to);
}

Rows& Rows::wholes(std::span<const std::int64_t> values) {
  Gathered& to = next(Type::kWhole, 1);
  const std::size_t shape[] = {values.size()};
  put_shape(to, schema_[at_], shape);
  for (const std::int64_t value : values) append(to.values, value);
  end_value();
  return *this;
}

Rows& Rows::reals(std::span<const double> values) {
  const std::size_t shape[] = {values.size()};
  return reals(values, shape);
}

Rows& Rows::reals(std::span<const double> values, std::span<const std::size_t> shape) {
  Gathered& to = next(Type::kReal64, static_cast<int>(shape.size()));
  put_shape(to, schema_[at_], shape);
  for (const double value : values) put_real(to, schema_[at_].type, value);
  end_value();
  return *this;
}

Rows& Rows::texts(std::span<const std::string> values) {
  Gathered& to = next(Type::kText, 1);
  const std::size_t shape[] = {values.size()};
  put_shape(to, schema_[at_], shape);
  for (const std::string& value : values) append_text(to.values, value);
  end_value();
  return *this;
}

std::size_t Rows::bytes() const {
  std::size_t sum = 0;
  for (const Gathered& column : columns_) sum += column.values.size();
  return sum;
}

void Rows::clear() {
  PROBE_CHECK(at_ == 0, "a row is not whole");
  columns_.assign(schema_.size(), {});
  count_ = 0;
}

}  // namespace probe::parquet
