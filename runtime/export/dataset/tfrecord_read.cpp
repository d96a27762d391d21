#include "runtime/export/dataset/tfrecord_read.h"

#include <bit>
#include <cstring>
#include <utility>

#include "runtime/export/dataset/tfrecord.h"

namespace probe::dataset {
namespace {

// A record of ours is an episode; a length beyond this is damage, and no memory is asked for.
constexpr std::uint64_t kLargestRecord = std::uint64_t{1} << 32;

template <typename T>
T number_of(std::string_view bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// A message of protocol buffers, field after field.
class Fields {
 public:
  explicit Fields(std::string_view message) : rest_(message) {}

  struct Field {
    std::uint64_t number = 0;
    std::uint64_t varint = 0;  // of a field that is one
    std::string_view bytes;    // of a field with a length
    bool has_bytes = false;
  };
  // Nothing behind the last; is_bad() tells a message that ends within a field.
  std::optional<Field> next() {
    if (rest_.empty() || is_bad_) return std::nullopt;
    const auto tag = varint();
    if (!tag) return bad();
    Field field;
    field.number = *tag >> 3;
    if ((*tag & 7) == 0) {
      const auto value = varint();
      if (!value) return bad();
      field.varint = *value;
      return field;
    }
    if ((*tag & 7) == 5) {  // four bytes
      if (rest_.size() < 4) return bad();
      field.bytes = rest_.substr(0, 4);
    } else if ((*tag & 7) == 2) {
      const auto size = varint();
      if (!size || *size > rest_.size()) return bad();
      field.bytes = rest_.substr(0, *size);
    } else {
      return bad();
    }
    rest_.remove_prefix(field.bytes.size());
    field.has_bytes = true;
    return field;
  }
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<std::uint8_t>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }
  bool is_empty() const { return rest_.empty(); }
  bool is_bad() const { return is_bad_; }

 private:
  std::optional<Field> bad() {
    is_bad_ = true;
    return std::nullopt;
  }
  std::string_view rest_;
  bool is_bad_ = false;
};

// BytesList, FloatList and Int64List all have their values in field 1.
bool read_list(std::uint64_t kind, std::string_view message, ExampleFeature& feature) {
  Fields list(message);
  while (const auto value = list.next()) {
    if (value->number != 1) return false;
    if (kind == 1) {
      if (!value->has_bytes) return false;
      feature.texts.emplace_back(value->bytes);
    } else if (kind == 2) {  // packed, or one
      if (!value->has_bytes || value->bytes.size() % sizeof(float) != 0) return false;
      for (std::size_t i = 0; i < value->bytes.size(); i += sizeof(float))
        feature.reals.push_back(static_cast<double>(number_of<float>(value->bytes.substr(i))));
    } else if (!value->has_bytes) {
      feature.wholes.push_back(std::bit_cast<std::int64_t>(value->varint));
    } else {
      Fields packed(value->bytes);
      while (!packed.is_empty()) {
        const auto number = packed.varint();
        if (!number) return false;
        feature.wholes.push_back(std::bit_cast<std::int64_t>(*number));
      }
    }
  }
  return !list.is_bad();
}

bool read_feature(std::string_view message, ExampleFeature& feature) {
  Fields fields(message);
  while (const auto list = fields.next()) {
    if (list->number < 1 || list->number > 3 || !list->has_bytes ||
        !read_list(list->number, list->bytes, feature))
      return false;
  }
  return !fields.is_bad();
}

bool read_features(std::string_view message, Example& example) {
  Fields entries(message);
  while (const auto entry = entries.next()) {
    if (entry->number != 1 || !entry->has_bytes) return false;
    Fields pair(entry->bytes);
    std::string key;
    ExampleFeature feature;
    while (const auto part = pair.next()) {
      if (!part->has_bytes) return false;
      if (part->number == 1) {
        key = part->bytes;
      } else if (part->number != 2 || !read_feature(part->bytes, feature)) {
        return false;
      }
    }
    if (pair.is_bad()) return false;
    example.insert_or_assign(std::move(key), std::move(feature));
  }
  return !entries.is_bad();
}

}  // namespace

RecordReader::RecordReader(std::string path)
    : path_(std::move(path)), file_(path_, std::ios::binary) {}

Result<std::optional<std::string>> RecordReader::next() {
  const auto damaged = [&](const std::string& what) {
    return Failure{Fault::kIo, "record " + std::to_string(number_) + " " + what, path_};
  };
  if (!file_.is_open()) return Failure{Fault::kIo, "cannot be read", path_};
  std::string head(12, '\0');
  file_.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (file_.gcount() == 0) return std::optional<std::string>();
  if (file_.gcount() != 12) return damaged("is cut off");
  const std::string_view size_bytes = std::string_view(head).substr(0, 8);
  if (number_of<std::uint32_t>(std::string_view(head).substr(8)) != masked_crc32c(size_bytes))
    return damaged("has a length whose checksum does not fit");
  const auto size = number_of<std::uint64_t>(size_bytes);
  if (size > kLargestRecord) return damaged("has an impossible length");
  std::string payload(size, '\0'), tail(4, '\0');
  file_.read(payload.data(), static_cast<std::streamsize>(size));
  file_.read(tail.data(), 4);
  if (file_.gcount() != 4) return damaged("is cut off");
  if (number_of<std::uint32_t>(tail) != masked_crc32c(payload))
    return damaged("has a content whose checksum does not fit");
  ++number_;
  return std::optional(std::move(payload));
}

Result<Example> read_example(std::string_view message, const std::string& where) {
  Example example;
  Fields fields(message);
  bool is_good = true;
  while (const auto features = fields.next())
    is_good = is_good && features->number == 1 && features->has_bytes &&
              read_features(features->bytes, example);
  if (!is_good || fields.is_bad()) return Failure{Fault::kIo, "is no tf.train.Example", where};
  return example;
}

}  // namespace probe::dataset
