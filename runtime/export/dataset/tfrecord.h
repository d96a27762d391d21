// TensorFlow's record files and the message in each record of ours: a tf.train.Example, which maps
// names to lists of numbers or bytes. Described at
// https://www.tensorflow.org/datasets/external_tfrecord and in tensorflow's record_writer.h.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

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
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  Status add(std::string_view payload);
  Status finish();  // the bytes are then on the disk

 private:
  RecordFile(std::FILE* file, std::string path) : file_(file), path_(std::move(path)) {}
  std::FILE* file_;
  std::string path_;
};

}  // namespace probe::dataset
