// What TRACE.md promises of damaged, cut, forged and swollen traces.
#include <doctest/doctest.h>
#include <zstd.h>

#include <fstream>
#include <iterator>
#include <random>

#include "runtime/store/trace.h"
#include "runtime/store/trace_codec.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_trace.h"

namespace probe::store {
using namespace probe::run;
namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string packed(const std::string& content) {
  std::string out(ZSTD_compressBound(content.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), content.data(), content.size(), 19));
  return out;
}

std::string unpacked(const std::string& bytes) {
  std::string out(1 << 20, '\0');
  ZSTD_DCtx* context = ZSTD_createDCtx();
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  ZSTD_outBuffer to{out.data(), out.size(), 0};
  while (in.pos < in.size && ZSTD_isError(ZSTD_decompressStream(context, &to, &in)) == 0) {
  }
  ZSTD_freeDCtx(context);
  out.resize(to.pos);
  return out;
}

// A chunk with its right check word.
std::string chunk(codec::Tag tag, const std::string& payload) {
  ByteWriter head;
  head.u32(static_cast<std::uint32_t>(tag));
  head.u32(static_cast<std::uint32_t>(payload.size()));
  std::string bytes(reinterpret_cast<const char*>(head.bytes().data()), head.bytes().size());
  bytes += payload;
  const Sha256 check = sha256(std::as_bytes(std::span(bytes)));
  return bytes + std::string(reinterpret_cast<const char*>(check.bytes.data()), 8);
}

TEST_CASE("cut at any byte, a trace is readable up to its last whole step and strictly refused") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 3).ok());
  const std::string bytes = read_file(folder / "a.trace");
  std::size_t steps = 0, readable = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_file(folder / "cut.trace", bytes.substr(0, size));
    const auto strict = read_trace(folder / "cut.trace");
    REQUIRE_FALSE(strict.ok());
    CHECK(strict.failure().code == Fault::kTrace);
    const auto prefix = read_trace_prefix(folder / "cut.trace");
    if (!prefix.ok()) {
      CHECK(steps == 0);  // nothing that was readable is lost again
      continue;
    }
    ++readable;
    CHECK_FALSE(prefix->incomplete.empty());
    CHECK(prefix->header.task == "carrot_on_plate");
    REQUIRE(prefix->steps.size() >= steps);
    steps = prefix->steps.size();
    for (std::size_t i = 0; i < steps; ++i) {
      const TraceStep want = sample_step(static_cast<int>(i) + 1);
      CHECK(prefix->steps[i].action == want.action);
      CHECK(prefix->steps[i].image_hash == want.image_hash);
      CHECK(prefix->steps[i].state_hash == want.state_hash);
    }
  }
  CHECK(steps == 3);
  MESSAGE(readable << " of " << bytes.size() << " cuts were readable");
}

TEST_CASE("a writer that dies after each step leaves exactly these steps") {
  TemporaryFolder folder;
  for (int steps = 0; steps <= 3; ++steps) {
    {
      auto writer = TraceWriter::create(folder / "dead.trace", sample_header());
      REQUIRE(writer.ok());
      REQUIRE((*writer)->start(sample_start()).ok());
      for (int i = 1; i <= steps; ++i) REQUIRE((*writer)->step(sample_step(i)).ok());
    }
    const auto prefix = read_trace_prefix(folder / "dead.trace");
    REQUIRE(prefix.ok());
    CHECK(prefix->start.has_value());
    CHECK(prefix->steps.size() == static_cast<std::size_t>(steps));
    CHECK_FALSE(read_trace(folder / "dead.trace").ok());
  }
}

TEST_CASE("random damage is refused, or changes nothing that the hash covers") {
  TemporaryFolder folder;
  const auto hash = write_sample_trace(folder / "a.trace", 3);
  REQUIRE(hash.ok());
  const std::string bytes = read_file(folder / "a.trace");
  std::mt19937_64 draw(5);
  int refused = 0, harmless = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    const std::size_t count = 1 + draw() % 4;
    for (std::size_t k = 0; k < count; ++k)
      damaged[draw() % damaged.size()] = static_cast<char>(draw());
    if (damaged == bytes) continue;
    write_file(folder / "bad.trace", damaged);
    const auto trace = read_trace(folder / "bad.trace");
    if (!trace.ok()) {
      ++refused;
      continue;
    }
    ++harmless;
    CHECK(trace->hash == *hash);
  }
  MESSAGE(refused << " refused, " << harmless << " harmless");
  CHECK(refused > 100 * harmless);
}

TEST_CASE("damage inside the content, compressed again, is found by the check words") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 2).ok());
  const std::string content = unpacked(read_file(folder / "a.trace"));
  REQUIRE(content.size() > 500);
  write_file(folder / "same.trace", packed(content));
  CHECK(read_trace(folder / "same.trace").ok());
  int refused = 0, tried = 0;
  for (std::size_t at = 0; at < content.size(); at += 3) {
    std::string damaged = content;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    write_file(folder / "bad.trace", packed(damaged));
    ++tried;
    refused += read_trace(folder / "bad.trace").ok() ? 0 : 1;
  }
  CHECK(refused == tried);
}

TEST_CASE("chunks out of order are refused, with good check words too") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 2).ok());
  const std::string content = unpacked(read_file(folder / "a.trace"));
  const std::string head = content.substr(0, 16);
  std::vector<std::string> chunks;
  for (std::size_t at = 16; at + 8 < content.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, content.data() + at + 4, sizeof size);
    chunks.push_back(content.substr(at, 16 + std::size_t{size}));
    at += 16 + std::size_t{size};
  }
  REQUIRE(chunks.size() == 9);  // HEAD FING SETL TIME STEP TIME STEP DONE HASH
  const auto reads = [&](const std::vector<std::size_t>& order) {
    std::string forged = head;
    for (const std::size_t i : order) forged += chunks[i];
    write_file(folder / "forged.trace", packed(forged));
    return read_trace(folder / "forged.trace").ok();
  };
  CHECK(reads({0, 1, 2, 3, 4, 5, 6, 7, 8}));
  CHECK_FALSE(reads({1, 0, 2, 3, 4, 5, 6, 7, 8}));
  CHECK_FALSE(reads({0, 1, 2, 5, 6, 3, 4, 7, 8}));
  CHECK_FALSE(reads({0, 1, 3, 4, 2, 5, 6, 7, 8}));
  CHECK_FALSE(reads({0, 1, 2, 3, 4, 7, 8}));
  CHECK_FALSE(reads({0, 1, 2, 3, 4, 5, 6, 6, 7, 8}));
  CHECK_FALSE(reads({0, 0, 1, 2, 3, 4, 5, 6, 7, 8}));
  CHECK_FALSE(reads({0, 1, 2, 3, 4, 5, 6, 7, 8, 8}));
  CHECK_FALSE(reads({0, 1, 2, 3, 4, 5, 6, 8, 7}));
}

TEST_CASE("records of other things than the header names are refused where they stand") {
  TemporaryFolder folder;
  const auto message = [&](auto&& change) {
    TraceHeader header = sample_header();
    TraceStart start = sample_start();
    TraceStep step = sample_step(1);
    TraceEnd end{1, {{"success", true, 0}, {"height", false, 0.125}}, std::nullopt};
    change(header, start, step, end);
    auto writer = TraceWriter::create(folder / "a.trace", header);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->start(start).ok());
    REQUIRE((*writer)->step(step).ok());
    REQUIRE((*writer)->finish(end).ok());
    const auto trace = read_trace(folder / "a.trace");
    return trace.ok() ? std::string() : trace.failure().message;
  };
  using H = TraceHeader&;
  using S = TraceStart&;
  using T = TraceStep&;
  using E = TraceEnd&;
  CHECK(message([](H, S, T, E) {}).empty());
  const std::string bad_start = "a settled start of other things than its header's, at the start";
  const std::string bad_step = "a step of other things than its header's, after the settled start";
  CHECK(message([](H h, S, T, E) { h.bodies.pop_back(); }) == bad_start);
  CHECK(message([](H h, S, T, E) { h.joints.emplace_back("elbow"); }) == bad_start);
  CHECK(message([](H, S s, T, E) { s.starts.pop_back(); }) == bad_start);
  CHECK(message([](H h, S, T, E) { h.metrics.pop_back(); }) == bad_step);
  CHECK(message([](H, S, T t, E) { t.sample.bodies.pop_back(); }) == bad_step);
  CHECK(message([](H, S, T t, E) { t.sample.contacts[0].b = 2; }) == bad_step);
  CHECK(message([](H, S, T t, E) { t.sample.contacts[0].b = 0; }) == bad_step);
  CHECK(message([](H, S, T t, E) { t.u.clear(); }) == bad_step);
  CHECK(message([](H, S, T, E e) {
          e.metrics[1].name = "depth";
        }).starts_with("an end with other metrics"));
  CHECK(message([](H, S, T, E e) { e.metrics.clear(), e.invalid = "the policy left"; }).empty());
}

TEST_CASE("another version and unknown chunks are refused") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 1).ok());
  std::string content = unpacked(read_file(folder / "a.trace"));
  std::string later = content;
  later[8] = 5;
  write_file(folder / "later.trace", packed(later));
  const auto refused = read_trace_prefix(folder / "later.trace");
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message == "trace format 5, this program reads 1 to 4");
  // A tool's actions are no joints'.
  later[8] = 3;
  write_file(folder / "joints.trace", packed(later));
  const auto joints = read_trace(folder / "joints.trace");
  REQUIRE_FALSE(joints.ok());
  CHECK(joints.failure().message.find("no count of an action's numbers") == 0);
  // A world that waited is no live one.
  later[8] = 2;
  write_file(folder / "live.trace", packed(later));
  const auto live = read_trace(folder / "live.trace");
  REQUIRE_FALSE(live.ok());
  CHECK(live.failure().message.find("no terms of a live episode") == 0);
  std::uint32_t size = 0;
  std::memcpy(&size, content.data() + 20, sizeof size);
  content.insert(32 + size, chunk(codec::Tag{0x3f3f3f3f}, "what"));
  write_file(folder / "unknown.trace", packed(content));
  const auto unknown = read_trace(folder / "unknown.trace");
  REQUIRE_FALSE(unknown.ok());
  CHECK(unknown.failure().message.find("unknown kind") != std::string::npos);
}

TEST_CASE("a small file cannot fill the memory") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 1).ok());
  const std::string content = unpacked(read_file(folder / "a.trace"));
  // A chunk that claims 4 GiB.
  std::string claims = content.substr(0, 16) + "HEAD\xff\xff\xff\xff";
  write_file(folder / "claims.trace", packed(claims));
  CHECK_FALSE(read_trace_prefix(folder / "claims.trace").ok());
  // 512 MiB of zeros in some kilobytes.
  std::string bomb;
  {
    ZSTD_CCtx* stream = ZSTD_createCCtx();
    std::string buffer(1 << 16, '\0');
    const std::string zeros(1 << 20, '\0');
    const auto put = [&](const std::string& plain, ZSTD_EndDirective directive) {
      ZSTD_inBuffer in{plain.data(), plain.size(), 0};
      for (std::size_t left = 1; in.pos < in.size || (directive == ZSTD_e_end && left > 0);) {
        ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
        left = ZSTD_compressStream2(stream, &out, &in, directive);
        bomb.append(buffer.data(), out.pos);
      }
    };
    put(content, ZSTD_e_continue);
    for (int i = 0; i < 512; ++i) put(zeros, ZSTD_e_continue);
    put({}, ZSTD_e_end);
    ZSTD_freeCCtx(stream);
  }
  CHECK(bomb.size() < 200'000);
  write_file(folder / "bomb.trace", bomb);
  const auto refused = read_trace(folder / "bomb.trace");
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.find("expanding") != std::string::npos);
}

}  // namespace
}  // namespace probe::store
