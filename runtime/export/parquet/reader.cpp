#include "runtime/export/parquet/reader.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>

#include "runtime/base/paths.h"
#include "runtime/export/parquet/format.h"
#include "runtime/export/parquet/thrift.h"

namespace probe::parquet {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::optional<std::vector<std::uint8_t>> part_of(const std::string& path, std::uint64_t begin,
                                                 std::uint64_t size) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(begin));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file) return std::nullopt;
  return bytes;
}

std::uint32_t u32_of(Bytes bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// Takes from the front; nothing, and an empty rest, where there is less.
std::optional<Bytes> take(Bytes& from, std::size_t size) {
  if (size > from.size()) return std::nullopt;
  const Bytes part = from.first(size);
  from = from.subspan(size);
  return part;
}

// Levels of `count` values, run lengths alone.
std::optional<std::vector<std::uint8_t>> levels(Bytes& from, std::size_t count, int most) {
  const auto head = take(from, 4);
  if (!head) return std::nullopt;
  auto bytes = take(from, u32_of(*head));
  if (!bytes) return std::nullopt;
  std::vector<std::uint8_t> out;
  while (out.size() < count) {
    std::uint64_t run = 0;
    int shift = 0;
    for (;; shift += 7) {
      const auto next = take(*bytes, 1);
      if (!next || shift > 56) return std::nullopt;
      run |= static_cast<std::uint64_t>((*next)[0] & 0x7f) << shift;
      if ((*next)[0] < 0x80) break;
    }
    const auto level = take(*bytes, 1);
    if (run % 2 != 0 || run / 2 == 0 || run / 2 > count - out.size() || !level ||
        (*level)[0] > most)
      return std::nullopt;
    out.insert(out.end(), static_cast<std::size_t>(run / 2), (*level)[0]);
  }
  if (!bytes->empty()) return std::nullopt;
  return out;
}

template <typename T, typename To>
bool numbers(Bytes from, std::size_t count, std::vector<To>& to) {
  if (from.size() != count * sizeof(T)) return false;
  to.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, from.data() + i * sizeof(T), sizeof value);
    to.push_back(value);
  }
  return true;
}

bool values_of(Bytes from, std::size_t count, ReadColumn& to) {
  switch (to.column.type) {
    case Type::kFlag:
      if (from.size() != (count + 7) / 8) return false;
      for (std::size_t i = 0; i < count; ++i) to.flags.push_back((from[i / 8] >> (i % 8)) & 1);
      return true;
    case Type::kWhole:
      return numbers<std::int64_t>(from, count, to.wholes);
    case Type::kReal32:
      return numbers<float>(from, count, to.reals);
    case Type::kReal64:
      return numbers<double>(from, count, to.reals);
    case Type::kText:
      for (std::size_t i = 0; i < count; ++i) {
        const auto size = take(from, 4);
        const auto text = size ? take(from, u32_of(*size)) : std::nullopt;
        if (!text) return false;
        to.texts.emplace_back(text->begin(), text->end());
      }
      return from.empty();
  }
  return false;
}

// The columns behind the root: a leaf, or groups `NAME (LIST) { list { element } }` around it.
std::optional<Schema> schema_of(const thrift::Value& elements) {
  Schema schema;
  const auto& all = elements.elements;
  if (all.empty()) return std::nullopt;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::string* name = all[i].bytes_at(4);
    if (name == nullptr) return std::nullopt;
    Column column{*name, Type::kFlag, 0};
    while (!all[i].whole_at(1)) {
      if (all[i].whole_at(6) != format::kListType || i + 2 >= all.size() ||
          all[i + 1].whole_at(3) != format::kRepeated || ++column.depth > kMostDepth)
        return std::nullopt;
      i += 2;
    }
    const auto type = format::type_of(*all[i].whole_at(1));
    if (!type || all[i].whole_at(3) != format::kOptional) return std::nullopt;
    column.type = *type;
    schema.push_back(column);
  }
  return schema;
}

}  // namespace

Result<Reader> Reader::open(const std::string& path) {
  Reader reader;
  reader.path_ = path;
  if (!is_file(path)) return reader.failed("there is no such file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto end = file.tellg();
  if (!file || end < 12) return reader.failed("is no Parquet file");
  reader.size_ = static_cast<std::uint64_t>(end);
  const auto tail = part_of(path, reader.size_ - 8, 8);
  const auto head = part_of(path, 0, 4);
  const auto is_magic = [](Bytes bytes) {
    return std::ranges::equal(bytes, format::kMagic, [](std::uint8_t a, char b) {
      return a == static_cast<std::uint8_t>(b);
    });
  };
  if (!tail || !head || !is_magic(*head) || !is_magic(Bytes(*tail).last(4)))
    return reader.failed("is no whole Parquet file");
  const std::uint64_t footer = u32_of(*tail);
  if (footer > reader.size_ - 12) return reader.failed("its footer is larger than the file");
  const auto bytes = part_of(path, reader.size_ - 8 - footer, footer);
  const auto read = bytes ? thrift::read_struct(*bytes) : std::nullopt;
  if (!read) return reader.failed("its footer cannot be read");

  const thrift::Value& all = read->value;
  const thrift::Value* elements = all.list_at(2);
  const auto schema = elements == nullptr ? std::nullopt : schema_of(*elements);
  if (!schema) return reader.failed("has columns that this reader does not know");
  reader.schema_ = *schema;
  if (const thrift::Value* notes = all.list_at(5)) {
    for (const thrift::Value& note : notes->elements) {
      const std::string *key = note.bytes_at(1), *value = note.bytes_at(2);
      if (key != nullptr) reader.notes_.emplace_back(*key, value == nullptr ? "" : *value);
    }
  }
  const thrift::Value* groups = all.list_at(4);
  if (groups == nullptr) return reader.failed("has no row groups");
  for (const thrift::Value& group : groups->elements) {
    Group out;
    const thrift::Value* chunks = group.list_at(1);
    out.rows = group.whole_at(3).value_or(-1);
    if (chunks == nullptr || chunks->elements.size() != schema->size() || out.rows < 0)
      return reader.failed("a row group does not have the file's columns");
    for (const thrift::Value& chunk : chunks->elements) {
      const thrift::Value* meta = chunk.struct_at(3);
      const auto number = [&](int id) { return meta->whole_at(id).value_or(-1); };
      if (meta == nullptr || number(4) != format::kUncompressed || meta->find(11) != nullptr)
        return reader.failed(
            "has compressed or dictionary columns, which this reader does not know");
      const std::int64_t begin = number(9), size = number(7), values = number(5);
      if (begin < 4 || size < 0 || values < 0 || static_cast<std::uint64_t>(begin) > reader.size_ ||
          static_cast<std::uint64_t>(size) > reader.size_ - static_cast<std::uint64_t>(begin))
        return reader.failed("a column lies outside of the file");
      out.chunks.push_back(
          {static_cast<std::uint64_t>(begin), static_cast<std::uint64_t>(size), values});
    }
    reader.rows_ += out.rows;
    reader.groups_.push_back(std::move(out));
  }
  if (all.whole_at(3) != reader.rows_)
    return reader.failed("its row groups have other rows than it says");
  return reader;
}

Result<ReadColumn> Reader::read_chunk(const Column& column, const Chunk& chunk,
                                      std::int64_t rows) const {
  const Failure damaged = failed("column `" + column.name + "` cannot be read");
  const auto bytes = part_of(path_, chunk.begin, chunk.size);
  const auto header = bytes ? thrift::read_struct(*bytes) : std::nullopt;
  if (!header) return damaged;
  const thrift::Value* page = header->value.struct_at(5);
  if (header->value.whole_at(1) != format::kDataPage || page == nullptr ||
      page->whole_at(1) != chunk.values || page->whole_at(2) != format::kPlain)
    return damaged;
  Bytes body = Bytes(*bytes).subspan(header->size);
  const auto count = static_cast<std::size_t>(chunk.values);
  // Run lengths can say much in few bytes.
  if (count > std::max<std::size_t>(std::size_t{1} << 20, 8 * body.size())) return damaged;
  std::optional<std::vector<std::uint8_t>> repetitions;
  if (column.depth > 0) {
    repetitions = levels(body, count, repetition_of(column));
    if (!repetitions) return damaged;
  }
  const auto definitions = levels(body, count, definition_of(column));
  if (!definitions) return damaged;

  ReadColumn out;
  out.column = column;
  std::size_t present = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!repetitions || (*repetitions)[i] == 0) out.begins.push_back(present);
    const bool is_there = (*definitions)[i] == definition_of(column);
    if (!is_there && !(column.depth == 1 && (*definitions)[i] == 1 && (*repetitions)[i] == 0))
      return failed("column `" + column.name + "` has nulls, which this reader does not know");
    if (is_there) ++present;
  }
  out.begins.push_back(present);
  if (out.rows() != static_cast<std::size_t>(rows) || !values_of(body, present, out))
    return damaged;
  return out;
}

Result<std::vector<ReadColumn>> Reader::read(std::size_t group) const {
  std::vector<ReadColumn> columns;
  for (std::size_t i = 0; i < schema_.size(); ++i) {
    PROBE_ASSIGN(ReadColumn column,
                 read_chunk(schema_[i], groups_[group].chunks[i], groups_[group].rows));
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace probe::parquet
