#include "compiler/source/source.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace probe;

TEST_CASE("lines and columns count from one, columns in characters") {
  SourceSet sources;
  const FileId id = sources.add("a.probe", "ab\nc\xc3\xa9z\r\n\nlast");
  const SourceFile& file = sources.file(id);
  CHECK(file.line_count() == 4);
  CHECK(file.line(1) == "ab");
  CHECK(file.line(2) == "c\xc3\xa9z");
  CHECK(file.line(3) == "");
  CHECK(file.line(4) == "last");
  CHECK(file.line_column(0) == LineColumn{1, 1});
  CHECK(file.line_column(2) == LineColumn{1, 3});
  CHECK(file.line_column(3) == LineColumn{2, 1});
  CHECK(file.line_column(6) == LineColumn{2, 3});
  CHECK(file.line_column(99) == LineColumn{4, 5});
}

TEST_CASE("an empty text has one empty line") {
  const SourceFile file("e.probe", "");
  CHECK(file.line_count() == 1);
  CHECK(file.line(1).empty());
  CHECK(file.line_column(0) == LineColumn{1, 1});
}

TEST_CASE("a byte order mark is kept and is no character") {
  const SourceFile file("b.probe", "\xef\xbb\xbfset");
  CHECK(file.text().size() == 6);
  CHECK(file.line_column(3) == LineColumn{1, 1});
}

TEST_CASE("a span outside the text is cut to it") {
  SourceSet sources;
  const FileId id = sources.add("a.probe", "abc");
  CHECK(sources.text({id, 1, 3}) == "bc");
  CHECK(sources.text({id, 1, 300}) == "bc");
  CHECK(sources.text({id, 200, 300}).empty());
}

TEST_CASE("a file is loaded once and keeps its address") {
  const auto path = (std::filesystem::temp_directory_path() / "probe_source_test.probe").string();
  std::ofstream(path, std::ios::binary) << "set a = b\n";
  SourceSet sources;
  const Result<FileId> first = sources.load(path);
  REQUIRE(first.ok());
  const SourceFile* const address = &sources.file(*first);
  for (int i = 0; i < 100; ++i) sources.add("other" + std::to_string(i), "x");
  const Result<FileId> second = sources.load(path);
  REQUIRE(second.ok());
  CHECK(*first == *second);
  CHECK(address == &sources.file(*second));
  CHECK(address->text() == "set a = b\n");
  std::remove(path.c_str());
}

TEST_CASE("a missing file and a folder are failures that name the path") {
  SourceSet sources;
  const Result<FileId> missing = sources.load("/nowhere/a.probe");
  REQUIRE(!missing.ok());
  CHECK(missing.failure().code == Fault::kIo);
  CHECK(missing.failure().where == "/nowhere/a.probe");
  const Result<FileId> folder = sources.load("/");
  REQUIRE(!folder.ok());
  CHECK(folder.failure().message == "cannot read: not a regular file");
}
