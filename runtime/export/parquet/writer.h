// A Parquet file, written from its beginning to its end.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/file_stream.h"
#include "runtime/base/result.h"
#include "runtime/export/parquet/rows.h"
#include "runtime/export/parquet/schema.h"

namespace probe::parquet {

class Writer {
 public:
  // `notes` are the file's own key-value pairs. Fails (kIo, where = path).
  static Result<std::unique_ptr<Writer>> create(
      const std::string& path, Schema schema,
      std::vector<std::pair<std::string, std::string>> notes = {});

  // A row group of all of `rows`, whose schema is the file's; none of no rows. Fails (kIo, where =
  // path).
  Status write(const Rows& rows);
  // Writes what the file holds and closes it; the bytes are then on the disk. Fails (kIo, where =
  // path).
  Status finish();

  std::uint64_t bytes() const { return at_; }  // written so far

 private:
  Writer(FileStream file, Schema schema, std::vector<std::pair<std::string, std::string>> notes);
  Status put(std::string_view bytes);

  FileStream file_;
  Schema schema_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::string groups_;  // Thrift, one element each
  std::size_t group_count_ = 0;
  std::int64_t rows_ = 0;
  std::uint64_t at_ = 0;
};

}  // namespace probe::parquet
