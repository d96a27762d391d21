#include "runtime/lsp/frames.h"

#include <doctest/doctest.h>

using namespace probe::lsp;

TEST_CASE("a message comes whole however its bytes arrive") {
  const std::string bytes = framed("{\"a\":1}") + framed("{}");
  for (std::size_t size = 1; size <= bytes.size(); ++size) {
    FrameReader reader;
    std::string all;
    for (std::size_t at = 0; at < bytes.size(); at += size) {
      reader.add(std::string_view(bytes).substr(at, size));
      while (const auto frame = reader.next()) all += frame->message + frame->mistake + "|";
    }
    CHECK(all == "{\"a\":1}|{}|");
  }
}

TEST_CASE("headers have no case, and others are passed over") {
  FrameReader reader;
  reader.add("content-type: x; charset=utf-8\r\nCONTENT-LENGTH:  2\r\n\r\nhi");
  CHECK(reader.next()->message == "hi");
}

TEST_CASE("bytes that are no header are named, and the next message is read") {
  FrameReader reader;
  reader.add("hello\r\n\r\n" + framed("{}"));
  CHECK(reader.next()->mistake == "expected a header `Content-Length: N`");
  CHECK(reader.next()->message == "{}");
}

TEST_CASE("a length that is no number, and one that is too large") {
  FrameReader reader;
  reader.add("Content-Length: -5\r\n\r\n");
  CHECK(reader.next()->mistake == "the Content-Length is no number of bytes");
  reader.add("Content-Length: 99999999999999999999999\r\n\r\n");
  CHECK(reader.next()->mistake == "the Content-Length is no number of bytes");
  reader.add("Content-Length: 67108865\r\n\r\nxxxx");
  CHECK(reader.next()->mistake == "a message of more than 64 MiB");
  // Its bytes are not kept, and what follows them is read.
  const std::string piece(1 << 20, 'x');
  std::size_t left = 67108865 - 4;
  while (left > 0) {
    const std::size_t size = std::min(left, piece.size());
    reader.add(std::string_view(piece).substr(0, size));
    left -= size;
    CHECK_FALSE(reader.next().has_value());
  }
  reader.add(framed("{}"));
  CHECK(reader.next()->message == "{}");
}

TEST_CASE("a length that no message has is not waited for") {
  FrameReader reader;
  reader.add("Content-Length: 99999999999999\r\n\r\n" + framed("{}"));
  CHECK(reader.next()->mistake == "a message of more than 1 GiB, which nobody sends");
  CHECK(reader.next()->message == "{}");
  reader.add("Content-Length: 18446744073709551615\r\n\r\n");
  CHECK(reader.next()->mistake == "a message of more than 1 GiB, which nobody sends");
  reader.add(framed("{\"a\":1}"));
  CHECK(reader.next()->message == "{\"a\":1}");
}

TEST_CASE("a line without end is given up") {
  FrameReader reader;
  reader.add(std::string(kMaxHeaderBytes + 1, 'y'));
  CHECK(reader.next()->mistake == "expected a header `Content-Length: N`, found a line of other bytes");
  reader.add(framed("{}"));
  CHECK(reader.next()->message == "{}");
}
