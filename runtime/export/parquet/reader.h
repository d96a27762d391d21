// Reads back what writer.h writes. Files may be of strangers: nothing is believed, and what this
// program would not have written is refused by name.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/export/parquet/schema.h"

namespace probe::parquet {

// A column of one row group; of the four lists of values only that of its type is used.
struct ReadColumn {
  Column column;
  std::vector<std::uint8_t> flags;
  std::vector<std::int64_t> wholes;
  std::vector<double> reals;  // of both widths
  std::vector<std::string> texts;
  // Where the values of row i begin; one more than there are rows.
  std::vector<std::size_t> begins = {};

  std::size_t rows() const { return begins.empty() ? 0 : begins.size() - 1; }
};

class Reader {
 public:
  // Fails (kIo, where = path) when it is no file, no Parquet, damaged, or of more than this reader
  // knows.
  static Result<Reader> open(const std::string& path);

  const Schema& schema() const { return schema_; }
  const std::vector<std::pair<std::string, std::string>>& notes() const { return notes_; }
  std::size_t group_count() const { return groups_.size(); }
  std::int64_t rows() const { return rows_; }
  // All columns of a row group, in the schema's order. Fails as open() does.
  Result<std::vector<ReadColumn>> read(std::size_t group) const;

 private:
  struct Chunk {
    std::uint64_t begin = 0, size = 0;
    std::int64_t values = 0;
  };
  struct Group {
    std::int64_t rows = 0;
    std::vector<Chunk> chunks;
  };
  Reader() = default;
  Failure failed(const std::string& what) const { return {Fault::kIo, what, path_}; }
  Result<ReadColumn> read_chunk(const Column& column, const Chunk& chunk, std::int64_t rows) const;

  std::string path_;
  std::uint64_t size_ = 0;
  Schema schema_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::vector<Group> groups_;
  std::int64_t rows_ = 0;
};

}  // namespace probe::parquet
