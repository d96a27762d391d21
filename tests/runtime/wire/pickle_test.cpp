// Pickles as Python, numpy and PyTorch write them, read as data; and what is refused.
#include "runtime/wire/pickle.h"

#include <doctest/doctest.h>

#include <array>

#include "runtime/wire/pickle_arrays.h"
#include "tests/hex.h"
#include "tests/runtime/wire/pickle_samples.h"

namespace probe::wire {
namespace {

using Kind = PickleNode::Kind;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

std::string refusal(const Bytes& bytes) {
  const auto read = read_pickle(bytes, array_globals());
  return read ? "" : read.failure().message;
}

Result<Array> array_in(const Bytes& bytes) {
  PROBE_ASSIGN(const Pickle pickle, read_pickle(bytes, array_globals()));
  return read_array(pickle, pickle.top(), std::size_t{1} << 20);
}

Bytes written(const Array& array, bool is_tensor) {
  PickleWriter writer;
  is_tensor ? write_torch(array, writer) : write_numpy(array, writer);
  return writer.finish();
}

}  // namespace

TEST_CASE("what is written is read again: numbers, texts, lists, dicts") {
  PickleWriter writer;
  writer.value(Map{{"whole", -7},
                   {"large", std::int64_t{1} << 61},
                   {"real", 0.1},
                   {"text", "put carrot on plate"},
                   {"yes", true},
                   {"nothing", Value()},
                   {"list", List{1, "two", List{}}}});
  const Bytes bytes = writer.finish();
  const auto pickle = read_pickle(bytes, {});
  REQUIRE_MESSAGE(pickle.ok(), to_text(pickle.failure()));
  CHECK(pickle->size == bytes.size());
  const PickleNode& top = pickle->top();
  CHECK(pickle->find(top, "whole")->integer == -7);
  CHECK(pickle->find(top, "large")->integer == std::int64_t{1} << 61);
  CHECK(pickle->find(top, "real")->number == 0.1);
  CHECK(pickle->find(top, "text")->text == "put carrot on plate");
  CHECK(pickle->find(top, "yes")->kind == Kind::kBool);
  CHECK(pickle->find(top, "nothing")->kind == Kind::kNone);
  CHECK(describe(*pickle, *pickle->find(top, "list")) == "a list of 3");
  CHECK(pickle->find(top, "absent") == nullptr);
}

TEST_CASE("arrays are read as they were written, as numpy's and as PyTorch's") {
  const Array picture = array_u8({2, 1, 3}, {1, 2, 3, 4, 5, 255});
  const Array numbers = array_f64({2, 2}, {0.1, -2, 3e300, 4});
  const Array halves = array_f32({3}, {0.5, 1, -2});
  for (const Array& array : {picture, numbers, halves}) {
    const auto read = array_in(written(array, false));
    REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
    CHECK(*read == array);
  }
  for (const Array& array : {numbers, halves}) {
    const auto read = array_in(written(array, true));
    REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
    CHECK(*read == array);
  }
}

TEST_CASE("arrays that Python wrote are read") {
  for (const PickleSample& sample : kPickleSamples) {
    CAPTURE(sample.name);
    const auto read = array_in(test::from_hex(sample.hex));
    REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
    CHECK(read->dtype == std::string(sample.dtype));
    CHECK(read->shape == sample.shape);
    CHECK(*to_numbers(*read) == sample.numbers);
  }
}

TEST_CASE("bytes that protocol 2 holds as a text are bytes") {
  // pickle.dumps(numpy.array([[1.5, -200.25]]), protocol=2): with c3, bf and such in two bytes
  // each.
  const Bytes python = test::from_hex(
      "8002636e756d70792e636f72652e6d756c746961727261790a5f7265636f6e7374727563740a7100636e756d70"
      "790a6e6461727261790a71014b00857102635f636f646563730a656e636f64650a710358010000006271045806"
      "0000006c6174696e317105867106527107877108527109284b014b014b0286710a636e756d70790a6474797065"
      "0a710b58020000006638710c898887710d52710e284b0358010000003c710f4e4e4e4affffffff4affffffff4b"
      "00747110628968035812000000000000000000c3b83f00000000000869c3807111680586711252711374711462"
      "2e");
  const auto read = array_in(python);
  REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
  CHECK(*to_numbers(*read) == std::vector<double>{1.5, -200.25});
  // Another code, and a text that is no bytes.
  for (const char* const other : {"utf-8", "latin2"}) {
    PickleWriter writer;
    writer.global("_codecs encode");
    writer.begin_tuple();
    writer.text("abc");
    writer.text(other);
    writer.end_tuple();
    writer.call();
    CHECK_FALSE(array_in(writer.finish()).ok());
  }
}

TEST_CASE("nothing is run: a function that is not known is refused by its name") {
  CHECK(refusal(bytes_of("cos\nsystem\n(Vecho\ntR.")) ==
        "byte 0 of a pickle: the global `os system` is not read");
  CHECK(refusal(bytes_of("c__builtin__\neval\n.")) ==
        "byte 0 of a pickle: the global `__builtin__ eval` is not read");
  PickleWriter writer;
  writer.global("posix system");
  CHECK(refusal(writer.finish()).find("the global `posix system` is not read") !=
        std::string::npos);
}

TEST_CASE("opcodes that are not read are refused by their names") {
  struct Row {
    const char* name;
    std::uint8_t byte;
    bool is_read;
  };
  constexpr Row kRows[] = {
#define PICKLE_OPCODE(name, byte, is_read) {#name, byte, is_read},
#include "runtime/wire/pickle_opcodes.def"
#undef PICKLE_OPCODE
  };
  int refused = 0;
  for (const Row& row : kRows) {
    CAPTURE(row.name);
    const std::string why = refusal({row.byte});
    CHECK_FALSE(why.empty());
    CHECK((why == "byte 0 of a pickle: opcode " + std::string(row.name) + " is not read") ==
          !row.is_read);
    refused += row.is_read ? 0 : 1;
  }
  CHECK(refused == 28);
  CHECK(refusal({0xff}) == "byte 0 of a pickle: no opcode is 255");
}

TEST_CASE("pickles that do not hold together are refused where they stop doing so") {
  CHECK(refusal({}) == "byte 0 of a pickle: it ends in the middle");
  CHECK(refusal(bytes_of("X\xff\xff\xff\x7f")) == "byte 0 of a pickle: it ends in the middle");
  CHECK(refusal(bytes_of(".")) == "byte 0 of a pickle: the pickle ends with 0 values, not one");
  CHECK(refusal(bytes_of("NN.")) == "byte 2 of a pickle: the pickle ends with 2 values, not one");
  CHECK(refusal(bytes_of("a.")) == "byte 0 of a pickle: it takes values that are not there");
  CHECK(refusal(bytes_of("N(a.")) == "byte 2 of a pickle: it takes values that are not there");
  CHECK(refusal(bytes_of("t.")) == "byte 0 of a pickle: there is no mark");
  CHECK(refusal(bytes_of("NNa.")) == "byte 2 of a pickle: items for None");
  CHECK(refusal(bytes_of("}(Nu.")) == "byte 3 of a pickle: a key without a value");
  CHECK(refusal(bytes_of("h\x05.")) == "byte 0 of a pickle: value 5 was not kept");
  CHECK(refusal(bytes_of("N)R.")) == "byte 2 of a pickle: a call of None");
  CHECK(refusal(bytes_of("NNb.")) == "byte 2 of a pickle: a state for None");
  CHECK(refusal(Bytes(100, '(')) == "byte 64 of a pickle: marks more than 64 deep");
  CHECK(refusal(bytes_of("\x80\x06.")) == "byte 0 of a pickle: protocol 6");
  CHECK(refusal(Bytes(kMostValues + 2, 'N')).ends_with("more than 1048576 values"));
  CHECK(refusal(bytes_of("Nr\xff\xff\xff\xff.")).ends_with("value 4294967295 is kept"));
  // A list that holds itself is a list of one; nobody walks it.
  const Bytes loop = {']', 'q', 0, 'h', 0, 'a', '.'};
  const auto read = read_pickle(loop, {});
  REQUIRE(read.ok());
  CHECK(describe(*read, read->top()) == "a list of 1");
}

TEST_CASE("arrays that do not hold together are refused") {
  const auto why = [](const Bytes& bytes) {
    const auto read = array_in(bytes);
    return read ? std::string() : read.failure().message;
  };
  Array array = array_f32({3}, {1, 2, 3});
  array.shape = {4};
  CHECK(why(written(array, false)) == "an array whose 12 bytes do not fit its shape and dtype");
  CHECK(why(written(array, true)) == "a tensor that reaches beyond its storage");
  array.shape = {std::int64_t{1} << 40, std::int64_t{1} << 40};
  CHECK(why(written(array, false)).find("do not fit") != std::string::npos);
  CHECK(why(written(array, true)).find("a tensor") != std::string::npos);
  array.shape = {1, 1, 3};
  array.dtype = ">f4";
  CHECK(why(written(array, false)) == "an array of dtype `>f4`, which is not read");
  PickleWriter writer;
  writer.value(List{1});
  CHECK(why(writer.finish()) == "expected an array, got a list of 1");
}

}  // namespace probe::wire
