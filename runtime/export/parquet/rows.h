// Rows as they are gathered, stored as Parquet has them: a column's values one after the other, and
// the levels that say where lists begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/export/parquet/schema.h"

namespace probe::parquet {

// A column of some rows.
struct Gathered {
  std::vector<std::uint8_t> values;  // PLAIN; of flags one byte each
  std::size_t count = 0;             // of levels: values, and empty lists
  // Runs of equal levels, in order; of a column without lists there are no repetitions.
  struct Run {
    std::uint8_t level;
    std::size_t times;
  };
  std::vector<Run> definitions, repetitions;
};

// Each call gives the next column of the row its value; after the last one the next row begins. A
// value of another type or depth than the column's is a mistake of ours (PROBE_CHECK).
class Rows {
 public:
  explicit Rows(Schema schema);

  Rows& flag(bool value);
  Rows& whole(std::int64_t value);
  Rows& real(double value);  // rounded to the column's type
  Rows& text(std::string_view value);
  Rows& wholes(std::span<const std::int64_t> values);
  Rows& reals(std::span<const double> values);
  Rows& texts(std::span<const std::string> values);
  // Lists of lists: `shape` has the column's depth, `values` as many as its product.
  Rows& reals(std::span<const double> values, std::span<const std::size_t> shape);

  const Schema& schema() const { return schema_; }
  std::size_t count() const { return count_; }  // whole rows
  std::span<const Gathered> columns() const { return columns_; }
  std::size_t bytes() const;  // of all values
  void clear();

 private:
  Gathered& next(Type type, int depth);
  void put_real(Gathered& to, Type type, double value);
  void put_shape(Gathered& to, const Column& column, std::span<const std::size_t> shape);
  void end_value();
  Rows& end_one(Gathered& to);  // of a column of single values

  Schema schema_;
  std::vector<Gathered> columns_;
  std::size_t at_ = 0, count_ = 0;
};

}  // namespace probe::parquet
