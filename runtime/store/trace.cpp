// The container of a trace: chunks with check words inside one zstd stream that is flushed after
// every step.
#include "runtime/store/trace.h"

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/base/file.h"
#include "runtime/store/trace_codec.h"

namespace probe::store {
namespace {

using codec::Tag;

// A forged stream must not fill the memory: what a file may expand to is bounded by its own size.
// Every step has hashes, check words and times that do not compress, so no real trace comes near.
constexpr std::size_t kMaxContent = std::size_t{1} << 30;
constexpr std::size_t kMaxFile = std::size_t{256} << 20;
constexpr std::size_t kMaxExpansion = 1024;
constexpr std::size_t kFreeExpansion = std::size_t{1} << 20;
// The writer's window is 2 MiB; the decoder allocates what the file asks for.
constexpr int kMaxWindowLog = 23;

std::size_t allowed_content(std::size_t file_bytes) {
  return std::min(kMaxContent, kFreeExpansion + kMaxExpansion * file_bytes);
}

constexpr std::size_t kCheckBytes = 8;

// The first bytes of a chunk's hash, tag and size included.
std::array<std::byte, kCheckBytes> check_of(std::span<const std::byte> chunk) {
  const Sha256 hash = sha256(chunk);
  std::array<std::byte, kCheckBytes> check;
  std::memcpy(check.data(), hash.bytes.data(), kCheckBytes);
  return check;
}

class FileTraceWriter final : public TraceWriter {
 public:
  FileTraceWriter(std::string path, int file) : path_(std::move(path)), file_(file) {
    stream_ = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(stream_, ZSTD_c_compressionLevel, 3);
    ZSTD_CCtx_setParameter(stream_, ZSTD_c_checksumFlag, 1);
  }
  ~FileTraceWriter() override {
    ZSTD_freeCCtx(stream_);
    if (file_ >= 0) ::close(file_);
  }

  Status begin(const TraceHeader& header) {
    ByteWriter head;
    for (const std::uint8_t byte : codec::kMagic) head.u8(byte);
    is_live_ = header.live.has_value();
    action_size_ = header.action_size();
    head.u32(codec::kVersion + (is_live_ ? codec::kOfLive : 0) +
             (header.joint_actions ? codec::kOfJoints : 0));
    head.u32(0);
    PROBE_TRY(compress(head.bytes(), ZSTD_e_continue));
    ByteWriter payload;
    codec::put_header(payload, header);
    PROBE_TRY(chunk(Tag::kHead, payload.bytes()));
    if (header.joint_actions) {
      ByteWriter actions;
      codec::put_actions(actions, *header.joint_actions);
      PROBE_TRY(chunk(Tag::kActions, actions.bytes()));
    }
    if (!header.later.empty()) {
      ByteWriter later;
      codec::put_later(later, header.later);
      PROBE_TRY(chunk(Tag::kLater, later.bytes()));
    }
    if (is_live_) {
      ByteWriter terms;
      codec::put_terms(terms, *header.live);
      PROBE_TRY(chunk(Tag::kLive, terms.bytes()));
    }
    ByteWriter fingerprint;
    fingerprint.text(header.fingerprint);
    PROBE_TRY(chunk(Tag::kFingerprint, fingerprint.bytes()));
    return flush();
  }

  Status start(const TraceStart& start) override {
    ByteWriter payload;
    codec::put_start(payload, start);
    PROBE_TRY(chunk(Tag::kSettled, payload.bytes()));
    return flush();
  }

  Status step(const TraceStep& step) override {
    PROBE_CHECK(step.live.has_value() == is_live_, "every step of a live trace is a live one");
    PROBE_CHECK(step.action.size() == action_size_, "actions of the robot that the header is of");
    ByteWriter payload;
    codec::put_step(payload, step);
    ByteWriter timing;
    for (const double seconds : {step.render_s, step.policy_s, step.physics_s}) timing.f64(seconds);
    if (step.live) {
      const auto& answers = step.live->answers;
      for (std::size_t i = 0; i < policy::kMostAnswersOfAStep; ++i)
        timing.f64(i < answers.size() ? answers[i].answer_s : 0);
    }
    // The timing goes first, so that a whole step in the file has it.
    PROBE_TRY(chunk(Tag::kTime, timing.bytes()));
    if (!step.sample.own.empty()) {
      ByteWriter own;
      codec::put_own(own, step);
      PROBE_TRY(chunk(Tag::kOwn, own.bytes()));
    }
    PROBE_TRY(chunk(Tag::kStep, payload.bytes()));
    return flush();
  }

  Result<Sha256> finish(const TraceEnd& end) override {
    ByteWriter payload;
    codec::put_end(payload, end);
    PROBE_TRY(chunk(Tag::kDone, payload.bytes()));
    const Sha256 hash = hasher_.finish();
    ByteWriter sum;
    sum.hash(hash);
    PROBE_TRY(chunk(Tag::kHash, sum.bytes()));
    PROBE_TRY(compress({}, ZSTD_e_end));
    if (::fsync(file_) != 0) return failed("cannot be forced to the disk");
    const int file = file_;
    file_ = -1;
    if (::close(file) != 0) return failed("cannot be closed");
    return hash;
  }

 private:
  Failure failed(const char* what) const {
    return {Fault::kStore, std::string(what) + ": " + std::strerror(errno), path_};
  }

  Status chunk(Tag tag, std::span<const std::byte> payload) {
    ByteWriter bytes;
    bytes.u32(static_cast<std::uint32_t>(tag));
    bytes.u32(static_cast<std::uint32_t>(payload.size()));
    std::vector<std::byte> whole = bytes.bytes();
    whole.insert(whole.end(), payload.begin(), payload.end());
    if (is_hashed(tag)) hasher_.bytes(whole);
    const auto check = check_of(whole);
    whole.insert(whole.end(), check.begin(), check.end());
    return compress(whole, ZSTD_e_continue);
  }

  Status flush() { return compress({}, ZSTD_e_flush); }

  Status compress(std::span<const std::byte> bytes, ZSTD_EndDirective directive) {
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    std::vector<char> buffer(ZSTD_CStreamOutSize());
    for (;;) {
      ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
      const std::size_t left = ZSTD_compressStream2(stream_, &out, &in, directive);
      if (ZSTD_isError(left) != 0) {
        return Failure{Fault::kStore, std::string("zstd: ") + ZSTD_getErrorName(left), path_};
      }
      PROBE_TRY(write(std::span(buffer).first(out.pos)));
      if (directive == ZSTD_e_continue ? in.pos == in.size : left == 0) return {};
    }
  }

  Status write(std::span<const char> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return failed("cannot be written");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
  }

  std::string path_;
  int file_;
  bool is_live_ = false;
  std::size_t action_size_ = robot::kActionSize;
  ZSTD_CCtx* stream_ = nullptr;
  Hasher hasher_;
};

struct Content {
  std::vector<std::byte> bytes;
  std::string incomplete;
};

// What can be decompressed from the front, and why not more.
Result<Content> decompress(const std::string& path) {
  PROBE_ASSIGN(const std::string packed,
               read_file(path, {.most = kMaxFile, .code = Fault::kTrace}));
  // Made once a thread: of a short trace, making them is a good part of the work.
  thread_local const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> stream(
      ZSTD_createDCtx(), ZSTD_freeDCtx);
  thread_local std::vector<char> plain(ZSTD_DStreamOutSize());
  ZSTD_DCtx_reset(stream.get(), ZSTD_reset_session_and_parameters);
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  Content content;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  const auto at = [&](const char* what) { return what + (" " + std::to_string(in.pos)); };
  for (;;) {
    ZSTD_outBuffer out{plain.data(), plain.size(), 0};
    const std::size_t code = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(code) != 0) {
      content.incomplete = at("damaged before byte") + " (" + ZSTD_getErrorName(code) + ")";
      return content;
    }
    const auto* begin = reinterpret_cast<const std::byte*>(plain.data());
    content.bytes.insert(content.bytes.end(), begin, begin + out.pos);
    if (content.bytes.size() > allowed_content(in.pos)) {
      content.incomplete = at("expanding beyond any episode at byte");
      return content;
    }
    if (code == 0) break;
    if (in.pos == in.size && out.pos < out.size) {
      content.incomplete = at("truncated at byte");
      return content;
    }
  }
  if (in.pos < in.size) content.incomplete = at("bytes after the end, at byte");
  return content;
}

std::string after(const Trace& trace) {
  return trace.steps.empty() ? std::string(trace.start ? "after the settled start" : "at the start")
                             : "after step " + std::to_string(trace.steps.size());
}

bool is_known(Tag tag) {
  return is_hashed(tag) || tag == Tag::kFingerprint || tag == Tag::kTime || tag == Tag::kHash;
}

// What a record must have of what its header names: nobody behind the reader counts again.
bool fits(const TraceHeader& header, const vm::StepSample& sample) {
  const std::size_t bodies = header.bodies.size();
  return sample.bodies.size() == bodies &&
         std::ranges::all_of(sample.contacts, [&](const vm::ContactSample& contact) {
           return contact.a < contact.b && contact.b < bodies;
         });
}
bool fits(const TraceHeader& header, const TraceStart& start) {
  return start.starts.size() == header.bodies.size() && start.q.size() == header.joints.size() &&
         fits(header, start.sample);
}
bool fits(const TraceHeader& header, const TraceStep& step) {
  return step.q.size() == header.joints.size() && step.u.size() == header.joints.size() &&
         step.metrics.size() == header.metrics.size() && fits(header, step.sample);
}
// An answer is to a question that went out before, with an observation of this trace, one after the
// other; a second one of a step is to the question that went out in its middle.
bool fits(const std::vector<TraceStep>& before, const TraceStep& step) {
  if (!step.live || step.live->answers.empty()) return true;
  const auto has_answers = [](const TraceStep& earlier) { return !earlier.live->answers.empty(); };
  const auto last = std::find_if(before.rbegin(), before.rend(), has_answers);
  int answered = last == before.rend() ? -1 : last->live->answers.back().asked;
  for (std::size_t i = 0; i < step.live->answers.size(); ++i) {
    const int asked = step.live->answers[i].asked;
    const auto at = static_cast<std::size_t>(asked);
    if (asked <= answered || at > before.size() || (i > 0 && at != before.size())) return false;
    if (!(at < before.size() ? before[at].live->asks : step.live->asks)) return false;
    answered = asked;
  }
  return true;
}
bool fits(const TraceHeader& header, const TraceEnd& end) {
  const auto is_same = [](const MetricValue& value, const TraceHeader::Metric& metric) {
    return value.name == metric.name && value.is_bool == metric.is_bool;
  };
  return end.invalid || std::ranges::equal(end.metrics, header.metrics, is_same);
}

// Seconds of rendering, policy, physics; of a live step those of its answers.
using LiveTiming = std::array<double, 3 + policy::kMostAnswersOfAStep>;

// What stands in the file before the step that it is of.
struct Ahead {
  LiveTiming timing{};
  std::optional<std::vector<vm::OwnPlace>> own;
};

// The same bodies in every step, each once.
bool fits(const Trace& trace, const std::vector<vm::OwnPlace>& own) {
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i].body >= trace.header.bodies.size()) return false;
    if (i > 0 && own[i].body <= own[i - 1].body) return false;
  }
  return trace.steps.empty() || std::ranges::equal(own, trace.steps.front().sample.own, {},
                                                   &vm::OwnPlace::body, &vm::OwnPlace::body);
}

// One chunk into the trace; what is wrong with it, if anything is.
std::string accept(Trace& trace, bool is_live, bool is_of_joints, bool& has_header, Ahead& ahead,
                   Tag tag, std::span<const std::byte> payload) {
  if (!is_known(tag)) return "a chunk of unknown kind";
  if ((tag == Tag::kHead) == has_header) return has_header ? "a second header" : "no header";
  const bool needs_start = tag == Tag::kStep || tag == Tag::kTime || tag == Tag::kOwn;
  if (needs_start && !trace.start) return "a step before the settled start";
  if (trace.end && tag != Tag::kHash) return "a chunk after the end";
  if (has_header && is_of_joints && !trace.header.joint_actions && tag != Tag::kActions)
    return "no count of an action's numbers";
  if (has_header && is_live && !trace.header.live && tag != Tag::kLive && tag != Tag::kLater &&
      tag != Tag::kActions)
    return "no terms of a live episode";
  ByteReader from(payload);
  switch (tag) {
    case Tag::kHead: {
      auto header = codec::get_header(payload);
      if (!header) return "a header of another form";
      trace.header = std::move(*header);
      has_header = true;
      return {};
    }
    case Tag::kActions:
      if (!is_of_joints || trace.header.joint_actions)
        return "a count of an action's numbers where none belongs";
      trace.header.joint_actions = codec::get_actions(payload);
      if (trace.header.joint_actions &&
          trace.header.joint_actions->count > trace.header.joints.size() + 1)
        return "more numbers of an action than its header has joints";
      return trace.header.joint_actions ? "" : "a count of an action's numbers of another form";
    case Tag::kLater: {
      if (trace.start || trace.header.live || !trace.header.later.empty())
        return "later sentences where none belong";
      auto later = codec::get_later(payload);
      if (!later) return "later sentences of another form";
      trace.header.later = std::move(*later);
      return {};
    }
    case Tag::kLive:
      if (!is_live || trace.header.live) return "terms of a live episode where none belong";
      trace.header.live = codec::get_terms(payload);
      return trace.header.live ? "" : "terms of a live episode of another form";
    case Tag::kFingerprint:
      trace.header.fingerprint = from.text();
      return from.ok() && from.left() == 0 ? "" : "a fingerprint of another form";
    case Tag::kSettled: {
      if (trace.start) return "a second settled start";
      auto start = codec::get_start(payload);
      if (!start) return "a settled start of another form";
      if (!fits(trace.header, *start)) return "a settled start of other things than its header's";
      trace.start = std::move(start);
      return {};
    }
    case Tag::kTime:
      for (std::size_t i = 0; i < (is_live ? ahead.timing.size() : 3u); ++i)
        ahead.timing[i] = from.f64();
      return from.ok() && from.left() == 0 ? "" : "a timing of another form";
    case Tag::kOwn:
      if (ahead.own) return "two places of what moves by itself before one step";
      ahead.own = codec::get_own(payload);
      if (!ahead.own || ahead.own->empty()) return "places of what moves by itself of another form";
      return {};
    case Tag::kStep: {
      auto step = codec::get_step(payload, is_live, trace.header.action_size());
      if (!step) return "a step of another form";
      if (!fits(trace.steps, *step)) return "an answer to a question that was not asked";
      if (!fits(trace.header, *step)) return "a step of other things than its header's";
      step->render_s = ahead.timing[0];
      step->policy_s = ahead.timing[1];
      step->physics_s = ahead.timing[2];
      for (std::size_t i = 0; step->live && i < step->live->answers.size(); ++i)
        step->live->answers[i].answer_s = ahead.timing[3 + i];
      if (ahead.own) step->sample.own = std::move(*std::exchange(ahead.own, {}));
      if (!fits(trace, step->sample.own)) return "a step in which other things move by themselves";
      trace.steps.push_back(std::move(*step));
      return {};
    }
    case Tag::kDone:
      trace.end = codec::get_end(payload);
      if (!trace.end) return "an end of another form";
      if (!fits(trace.header, *trace.end)) return "an end with other metrics than its header's";
      if (!trace.start && !trace.end->invalid) return "a valid end without a settled start";
      return trace.end->steps == trace.steps.size() ? ""
                                                    : "another number of steps than its end says";
    case Tag::kHash:
      if (!trace.end) return "a hash before the end";
      return payload.size() == sizeof(Sha256) ? "" : "a hash of another form";
  }
  return {};
}

}  // namespace

std::optional<std::vector<std::uint32_t>> sentences_said(const Trace& trace) {
  std::vector<Sha256> hashes = {sha256(trace.header.prompt)};
  for (const std::string& later : trace.header.later) hashes.push_back(sha256(later));
  std::vector<std::uint32_t> said;
  std::uint32_t now = 0;
  for (const TraceStep& step : trace.steps) {
    // Those in turn differ, so a step says which it is.
    if (step.prompt_hash != hashes[now] && !said.empty() && now + 1 < hashes.size()) ++now;
    if (step.prompt_hash != hashes[now]) return std::nullopt;
    said.push_back(now);
  }
  return said;
}

std::vector<int> turns_of(const Trace& trace) {
  std::vector<int> turns;
  const auto said = sentences_said(trace);
  for (std::size_t i = 1; said && i < said->size(); ++i) {
    if ((*said)[i] != (*said)[i - 1]) turns.push_back(static_cast<int>(i));
  }
  return turns;
}

Result<std::unique_ptr<TraceWriter>> TraceWriter::create(const std::string& path,
                                                         const TraceHeader& header) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) {
    return Failure{Fault::kStore, std::string("cannot be made: ") + std::strerror(errno), path};
  }
  auto writer = std::make_unique<FileTraceWriter>(path, file);
  PROBE_TRY(writer->begin(header));
  return std::unique_ptr<TraceWriter>(std::move(writer));
}

Result<Trace> read_trace_prefix(const std::string& path) {
  PROBE_ASSIGN(const Content content, decompress(path));
  ByteReader from(content.bytes);
  const auto magic = from.take(codec::kMagic.size());
  if (magic.empty() || std::memcmp(magic.data(), codec::kMagic.data(), magic.size()) != 0) {
    return Failure{
        Fault::kTrace,
        content.incomplete.empty() ? "not a trace" : "not a trace, or " + content.incomplete, path};
  }
  const std::uint32_t version = from.u32();
  const std::uint32_t zero = from.u32();
  if (from.ok() && (version < codec::kVersion || version > codec::kLastVersion)) {
    return Failure{Fault::kTrace,
                   "trace format " + std::to_string(version) + ", this program reads 1 to " +
                       std::to_string(codec::kLastVersion),
                   path};
  }
  const bool is_live = ((version - codec::kVersion) & codec::kOfLive) != 0;
  const bool is_of_joints = ((version - codec::kVersion) & codec::kOfJoints) != 0;

  if (zero != 0)
    return Failure{Fault::kTrace, "reserved bytes after the version are not zero", path};

  Trace trace;
  Hasher hasher;
  bool has_header = false, has_hash = false;
  Sha256 recorded;
  Ahead ahead;
  std::string wrong;
  while (wrong.empty() && from.left() > 0 && !has_hash) {
    const std::size_t begin = from.position();
    const Tag tag{from.u32()};
    const auto payload = from.take(from.u32());
    const std::size_t size = from.position() - begin;
    const auto check = from.take(kCheckBytes);
    if (!from.ok()) break;  // the rest of a truncated file
    const auto chunk = std::span(content.bytes).subspan(begin, size);
    if (std::memcmp(check_of(chunk).data(), check.data(), kCheckBytes) != 0) {
      wrong = "a chunk with another check word";
      break;
    }
    wrong = accept(trace, is_live, is_of_joints, has_header, ahead, tag, payload);
    if (!wrong.empty()) break;
    if (is_hashed(tag)) hasher.bytes(chunk);
    if (tag == Tag::kHash) {
      recorded = ByteReader(payload).hash();
      has_hash = true;
    }
  }
  if (!has_header) {
    return Failure{Fault::kTrace,
                   "no readable header: " + (wrong.empty() ? content.incomplete : wrong), path};
  }
  trace.hash = hasher.finish();
  if (wrong.empty()) wrong = content.incomplete;
  if (wrong.empty() && !has_hash) wrong = "truncated";
  if (wrong.empty() && from.left() > 0) wrong = "bytes after the end";
  if (wrong.empty() && recorded != trace.hash)
    wrong = "content that has another hash than recorded";
  if (!wrong.empty()) trace.incomplete = wrong + ", " + after(trace);
  return trace;
}

Result<Trace> read_trace(const std::string& path) {
  PROBE_ASSIGN(Trace trace, read_trace_prefix(path));
  if (!trace.incomplete.empty()) return Failure{Fault::kTrace, trace.incomplete, path};
  return trace;
}

}  // namespace probe::store
