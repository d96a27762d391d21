// Tables written are tables read, and damage is told. What others read is in ../lerobot_test.cpp.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "runtime/export/parquet/reader.h"
#include "runtime/export/parquet/thrift.h"
#include "runtime/export/parquet/writer.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::parquet {
namespace {

const Schema kEveryKind = {{"flag", Type::kFlag, 0},     {"whole", Type::kWhole, 0},
                           {"single", Type::kReal32, 0}, {"double", Type::kReal64, 0},
                           {"text", Type::kText, 0},     {"pair", Type::kReal32, 1},
                           {"words", Type::kText, 1},    {"stats/a/mean", Type::kReal64, 3}};

Rows rows_of_every_kind(int count) {
  Rows rows(kEveryKind);
  for (int i = 0; i < count; ++i) {
    const std::vector<std::string> words(static_cast<std::size_t>(i % 3), "w" + std::to_string(i));
    const std::size_t shape[] = {3, 1, 2};
    rows.flag(i % 3 == 1).whole(-i).real(0.1 * i).real(0.1 * i).text("täxt " + std::to_string(i));
    rows.reals(std::vector<double>{1.5 * i, -i / 3.0}).texts(words);
    rows.reals(std::vector<double>{1, 2, 3, 4, 5, 6.0 + i}, shape);
  }
  return rows;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("a table of every kind of column reads back as it was written, group by group") {
  const run::TemporaryFolder folder;
  const std::string path = folder / "a.parquet";
  auto writer = Writer::create(path, kEveryKind, {{"pandas", "{}"}, {"k", "ü"}});
  REQUIRE(writer.ok());
  REQUIRE((*writer)->write(rows_of_every_kind(20)).ok());
  REQUIRE((*writer)->write(rows_of_every_kind(0)).ok());  // no group
  REQUIRE((*writer)->write(rows_of_every_kind(3)).ok());
  REQUIRE((*writer)->finish().ok());

  const auto reader = Reader::open(path);
  REQUIRE_MESSAGE(reader.ok(), (reader.ok() ? "" : to_text(reader.failure())));
  CHECK(reader->schema() == kEveryKind);
  CHECK(reader->rows() == 23);
  REQUIRE(reader->group_count() == 2);
  CHECK(reader->notes() ==
        std::vector<std::pair<std::string, std::string>>{{"pandas", "{}"}, {"k", "ü"}});
  const auto first = reader->read(0), last = reader->read(1);
  REQUIRE(first.ok());
  REQUIRE(last.ok());
  const std::vector<ReadColumn>& columns = *first;
  for (int i = 0; i < 20; ++i) {
    const auto at = static_cast<std::size_t>(i);
    CHECK(columns[0].flags[at] == (i % 3 == 1));
    CHECK(columns[1].wholes[at] == -i);
    CHECK(columns[2].reals[at] == static_cast<float>(0.1 * i));
    CHECK(columns[3].reals[at] == 0.1 * i);
    CHECK(columns[4].texts[at] == "täxt " + std::to_string(i));
    CHECK(columns[5].begins[at] == 2 * at);
    CHECK(columns[5].reals[2 * at + 1] == static_cast<float>(-i / 3.0));
    CHECK(columns[6].begins[at + 1] - columns[6].begins[at] == at % 3);
    CHECK(columns[7].begins[at] == 6 * at);
    CHECK(columns[7].reals[6 * at + 5] == 6.0 + i);
  }
  CHECK((*last)[1].wholes == std::vector<std::int64_t>{0, -1, -2});
}

TEST_CASE("equal tables are equal bytes") {
  const run::TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    auto writer = Writer::create(folder / name, kEveryKind);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(rows_of_every_kind(7)).ok());
    REQUIRE((*writer)->finish().ok());
  }
  CHECK(text_of(folder / "a") == text_of(folder / "b"));
}

TEST_CASE("a file with any byte changed, or cut anywhere, is read or refused") {
  const run::TemporaryFolder folder;
  const std::string path = folder / "a.parquet", other = folder / "b.parquet";
  auto writer = Writer::create(path, kEveryKind);
  REQUIRE(writer.ok());
  REQUIRE((*writer)->write(rows_of_every_kind(4)).ok());
  REQUIRE((*writer)->finish().ok());
  const std::string whole = text_of(path);
  std::size_t refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    std::ofstream(other, std::ios::binary | std::ios::trunc) << bytes;
    const auto reader = Reader::open(other);
    if (!reader || (reader->group_count() > 0 && !reader->read(0))) ++refused;
  };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ change);
      attempt(changed);
    }
  }
  CHECK(refused > whole.size());
  refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) attempt(whole.substr(0, size));
  CHECK(refused == whole.size());
}

TEST_CASE("a full disk and a folder that is not there are told by the file's name") {
  auto writer = Writer::create("/dev/full", kEveryKind);
  REQUIRE(writer.ok());
  Status written = (*writer)->write(rows_of_every_kind(2000));
  if (written) written = (*writer)->finish();
  REQUIRE(!written.ok());
  CHECK(written.failure().code == Fault::kIo);
  CHECK(written.failure().where == "/dev/full");
  CHECK(Writer::create("/no/such/a.parquet", kEveryKind).failure().where == "/no/such/a.parquet");
}

TEST_CASE("Thrift's compact protocol is written to the byte") {
  thrift::Writer out;
  out.i32(1, 1).i64(3, -2).text(20, "ab").flag(21, true).list(22, thrift::Kind::kI32, 2);
  out.element_i32(5).element_i32(-300).begin(23).i16(1, 7).end().end();
  const std::string bytes(
      "\x15\x02\x26\x03\x08\x28\x02"
      "ab"
      "\x11\x19\x25\x0a\xd7\x04\x1c\x14\x0e\x00\x00",
      20);
  CHECK(out.bytes() == bytes);
  const auto read =
      thrift::read_struct({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  REQUIRE(read);
  CHECK(read->size == bytes.size());
  CHECK(read->value.whole_at(3) == -2);
  CHECK(*read->value.bytes_at(20) == "ab");
  CHECK(read->value.list_at(22)->elements[1].whole == -300);
  CHECK(read->value.struct_at(23)->whole_at(1) == 7);
}

}  // namespace
}  // namespace probe::parquet
