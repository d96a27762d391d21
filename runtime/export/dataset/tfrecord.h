// TensorFlow's record files and the message in each record of ours: a tf.train.Example, which maps
// names to lists of numbers or bytes. Described at
// https://www.tensorflow.org/datasets/external_tfrecord and in tensorflow's record_writer.h.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/base/file_stream.h"
#include "runtime/base/result.h"

namespace probe::dataset {

// CRC-32C (Castagnoli), as it is and in TensorFlow's disguise.
std::uint32_t crc32c(std::string_view bytes);
std::uint32_t masked_crc32c(std::string_view bytes);

class ExampleMessage {
 public:
  void bytes(const std::string& key, std::span<const std::string> values);
  void reals(const std::string& key, std::span<const float> values);
  void wholes(const std::string& key, std::span<const std::int64_t> values);
  // The message; its keys in the order of their bytes, so that equal contents are equal bytes.
  std::string finish() const;

 private:
  std::map<std::string, std::string> features_;  // the messages `Feature`
};

class RecordFile {
 public:
  // Fails (kIo, where = path).
  static Result<std::unique_ptr<RecordFile>> create(const std::string& path);

  Status add(std::string_view payload);
  Status finish() { return file_.finish(); }  // the bytes are then on the disk

 private:
  explicit RecordFile(FileStream file) : file_(std::move(file)) {}
  FileStream file_;
};

}  // namespace probe::dataset
