#include "runtime/export/parquet/writer.h"

#include "runtime/base/check.h"
#include "runtime/export/parquet/format.h"
#include "runtime/export/parquet/thrift.h"

namespace probe::parquet {
namespace {

using thrift::Kind;

// Readers know by this whom they may ask about faults of a file.
constexpr std::string_view kCreatedBy = "vlaprobe";

void put_u32(std::string& to, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) to.push_back(static_cast<char>(value >> shift));
}

// The hybrid of run lengths and packed bits, of which only run lengths are written.
void put_levels(std::string& to, const std::vector<Gathered::Run>& runs) {
  std::string bytes;
  for (const Gathered::Run& run : runs) {
    std::uint64_t head = static_cast<std::uint64_t>(run.times) << 1;
    for (; head >= 0x80; head >>= 7) bytes.push_back(static_cast<char>((head & 0x7f) | 0x80));
    bytes.push_back(static_cast<char>(head));
    bytes.push_back(static_cast<char>(run.level));  // of at most 8 bits
  }
  put_u32(to, bytes.size());
  to += bytes;
}

std::string page_of(const Column& column, const Gathered& gathered) {
  std::string page;
  if (repetition_of(column) > 0) put_levels(page, gathered.repetitions);
  put_levels(page, gathered.definitions);
  if (column.type != Type::kFlag) {
    page.append(gathered.values.begin(), gathered.values.end());
    return page;
  }
  for (std::size_t i = 0; i < gathered.values.size(); ++i) {
    if (i % 8 == 0) page.push_back('\0');
    page.back() = static_cast<char>(page.back() | (gathered.values[i] << (i % 8)));
  }
  return page;
}

std::string page_header(std::size_t size, std::size_t values) {
  thrift::Writer out;
  const auto bytes = static_cast<std::int32_t>(size);
  out.i32(1, format::kDataPage).i32(2, bytes).i32(3, bytes);
  out.begin(5)
      .i32(1, static_cast<std::int32_t>(values))
      .i32(2, format::kPlain)
      .i32(3, format::kRle)
      .i32(4, format::kRle)
      .end();
  out.end();
  return out.bytes();
}

// A logical type has no content: a union of one empty struct.
void logical_type(thrift::Writer& out, int which) { out.begin(10).begin(which).end().end(); }

void put_schema(thrift::Writer& out, const Schema& schema) {
  std::size_t count = 1;
  for (const Column& column : schema) count += 1 + 2 * static_cast<std::size_t>(column.depth);
  out.list(2, Kind::kStruct, count);
  out.element().text(4, "schema").i32(5, static_cast<std::int32_t>(schema.size())).end();
  for (const Column& column : schema) {
    for (int depth = 0; depth < column.depth; ++depth) {
      out.element().i32(3, format::kOptional).text(4, depth == 0 ? column.name : "element");
      out.i32(5, 1).i32(6, format::kListType);
      logical_type(out, 3);
      out.end();
      out.element().i32(3, format::kRepeated).text(4, "list").i32(5, 1).end();
    }
    out.element().i32(1, format::physical(column.type)).i32(3, format::kOptional);
    out.text(4, column.depth == 0 ? column.name : "element");
    if (column.type == Type::kText) {
      out.i32(6, format::kUtf8);
      logical_type(out, 1);
    }
    out.end();
  }
}

struct Chunk {
  std::uint64_t begin = 0;
  std::size_t size = 0;  // with the page's header
  std::size_t values = 0;
};

void put_chunk(thrift::Writer& out, const Column& column, const Chunk& chunk) {
  const auto size = static_cast<std::int64_t>(chunk.size);
  out.element().i64(2, 0).begin(3);
  out.i32(1, format::physical(column.type));
  out.list(2, Kind::kI32, 2).element_i32(format::kPlain).element_i32(format::kRle);
  out.list(3, Kind::kBinary, 1 + 2 * static_cast<std::size_t>(column.depth));
  out.element_text(column.name);
  for (int depth = 0; depth < column.depth; ++depth)
    out.element_text("list").element_text("element");
  out.i32(4, format::kUncompressed).i64(5, static_cast<std::int64_t>(chunk.values));
  out.i64(6, size).i64(7, size).i64(9, static_cast<std::int64_t>(chunk.begin));
  out.end().end();
}

}  // namespace

Writer::Writer(FileStream file, Schema schema,
               std::vector<std::pair<std::string, std::string>> notes)
    : file_(std::move(file)), schema_(std::move(schema)), notes_(std::move(notes)) {}

Result<std::unique_ptr<Writer>> Writer::create(
    const std::string& path, Schema schema,
    std::vector<std::pair<std::string, std::string>> notes) {
  PROBE_ASSIGN(FileStream file, FileStream::create(path));
  std::unique_ptr<Writer> writer(new Writer(std::move(file), std::move(schema), std::move(notes)));
  PROBE_TRY(writer->put(format::kMagic));
  return Result<std::unique_ptr<Writer>>(std::move(writer));
}

Status Writer::put(std::string_view bytes) {
  PROBE_TRY(file_.write(bytes));
  at_ += bytes.size();
  return {};
}

Status Writer::write(const Rows& rows) {
  PROBE_CHECK(rows.schema() == schema_, "rows of another table");
  if (rows.count() == 0) return {};
  thrift::Writer chunks;
  const std::uint64_t begin = at_;
  chunks.list(1, Kind::kStruct, schema_.size());
  for (std::size_t i = 0; i < schema_.size(); ++i) {
    const Gathered& gathered = rows.columns()[i];
    const std::string page = page_of(schema_[i], gathered);
    // Sizes of pages are 32-bit numbers.
    PROBE_CHECK(page.size() < (std::size_t{1} << 31), "a row group of more than 2 GiB");
    const std::string header = page_header(page.size(), gathered.count);
    const Chunk chunk{at_, header.size() + page.size(), gathered.count};
    PROBE_TRY(put(header));
    PROBE_TRY(put(page));
    put_chunk(chunks, schema_[i], chunk);
  }
  const auto size = static_cast<std::int64_t>(at_ - begin);
  chunks.i64(2, size).i64(3, static_cast<std::int64_t>(rows.count()));
  chunks.i64(5, static_cast<std::int64_t>(begin)).i64(6, size);
  chunks.end();
  groups_ += chunks.bytes();
  ++group_count_;
  rows_ += static_cast<std::int64_t>(rows.count());
  return {};
}

Status Writer::finish() {
  thrift::Writer out;
  out.i32(1, 2);
  put_schema(out, schema_);
  out.i64(3, rows_);
  out.list(4, Kind::kStruct, group_count_).raw(groups_);
  if (!notes_.empty()) out.list(5, Kind::kStruct, notes_.size());
  for (const auto& [key, value] : notes_) out.element().text(1, key).text(2, value).end();
  out.text(6, kCreatedBy).end();
  std::string tail = out.bytes();
  put_u32(tail, out.bytes().size());
  PROBE_TRY(put(tail));
  PROBE_TRY(put(format::kMagic));
  return file_.finish();
}

}  // namespace probe::parquet
