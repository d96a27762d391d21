// Record files and tf.train.Example messages read, by their descriptions and not by our writer.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::dataset {

// The records of a file, one after the other; each by its checksums.
class RecordReader {
 public:
  explicit RecordReader(std::string path);
  // Nothing behind the last. Fails (kIo, where = path) on a file that is not there, is cut off or
  // whose checksums do not fit.
  Result<std::optional<std::string>> next();

 private:
  std::string path_;
  std::ifstream file_;
  std::size_t number_ = 0;
};

// A feature of an Example: of the lists one has something.
struct ExampleFeature {
  std::vector<std::string> texts;
  std::vector<double> reals;  // floats
  std::vector<std::int64_t> wholes;
};
using Example = std::map<std::string, ExampleFeature>;

// Fails (kIo, at `where`) on what is no such message.
Result<Example> read_example(std::string_view message, const std::string& where);

}  // namespace probe::dataset
