// Conversations with policy servers of every protocol, over sockets of this machine: frames that a
// server says, frames that ours are asked, and the bytes that carry either.
#include <algorithm>
#include <sstream>

#include "runtime/servers/conformance.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "runtime/servers/transcript.h"
#include "runtime/wire/grpc.h"
#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"
#include "runtime/wire/zmq.h"
#include "tests/campaigns/damaging_proxy.h"
#include "tests/campaigns/driver.h"
#include "tests/campaigns/kinds.h"
#include "tests/runtime/scene/mutate.h"
#include "tests/servers/recorded_servers.h"

namespace probe::campaign {
namespace {

namespace fs = std::filesystem;
using namespace servers;
using scene::test::Dice;
using test::kRecordedServers;
using test::RecordedServer;
using wire::Duration;

constexpr Duration kPatient{10'000}, kShort{100};
constexpr std::size_t kLargestAnswer = std::size_t{16} << 20;

const RecordedServer& recorded_as(const std::string& file) {
  return *std::ranges::find(kRecordedServers, file, &RecordedServer::file);
}

Form form_of_frames(Protocol protocol) {
  if (protocol == Protocol::kOpenVla) return Form::kJson;
  return protocol == Protocol::kLeRobot ? Form::kBytes : Form::kMsgpack;
}

Result<ServerChoice> choice_at(const std::string& port, const RecordedServer& recorded,
                               bool is_patient) {
  const std::string wait = is_patient ? "10" : "0.1";
  PROBE_ASSIGN(ServerChoice choice,
               choose_server(recorded.protocol,
                             "//127.0.0.1:" + port + "?timeout.wait_s=0.05&timeout.connect_s=" +
                                 wait + "&timeout.first_s=" + wait + "&timeout.answer_s=" + wait +
                                 "&answer.largest_mib=16" + recorded.options));
  // Small pictures are quick to send; LeRobot's answers are of the pictures that were asked about.
  for (ImageRule& image : choice.profile.images) {
    if (image.width == 0 && recorded.protocol != Protocol::kLeRobot)
      image.width = image.height = 32;
  }
  return choice;
}

// Opens, asks in two episodes, and looks at the answers as `policy test` does.
Status converse(const ServerChoice& choice) {
  PROBE_ASSIGN(const auto transport, make_transport(choice));
  KnownObservations known(choice.profile, *transport, known_arm(choice.profile));
  PROBE_TRY(known.open());
  transport->remarks();
  std::vector<Chunk> chunks;
  for (int picture = 0; picture < 2; ++picture) {
    PROBE_ASSIGN(Chunk chunk, known.ask({.picture = picture}));
    chunks.push_back(std::move(chunk));
  }
  judge_answers(known.profile(), chunks, known.arm());
  transport->notes();
  return transport->listen(Duration{1});
}

void damage_frame(wire::Frame& frame, Form form, Dice& dice) {
  const std::string bytes =
      damaged(text_of(std::span<const std::uint8_t>(frame.bytes)), form, dice.below(1u << 30));
  frame.bytes.assign(bytes.begin(), bytes.end());
}

// One or two frames of what one side says.
std::string damaged_transcript(const std::string& text, bool questions, std::uint64_t seed) {
  auto read = parse_transcript(text, "sample");
  if (!read) return text;
  Dice dice(seed ^ 0x165667b1);
  const Form form = form_of_frames(read->protocol);
  for (std::size_t changes = 1 + dice.below(2); changes > 0; --changes) {
    auto& lines = read->connections[dice.below(read->connections.size())];
    std::vector<std::size_t> said;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].is_question == questions) said.push_back(i);
    }
    if (said.empty()) continue;
    // The first are those that are always heard.
    const std::size_t among =
        dice.below(8) == 0 ? said.size() : std::min<std::size_t>(said.size(), 5);
    const std::size_t at = said[dice.below(among)];
    wire::Frame frame = lines[at].frame;
    switch (dice.below(16)) {
      case 0:
        frame = lines[said[dice.below(said.size())]].frame;
        break;
      case 1:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        continue;
      case 2:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), Line(lines[at]));
        continue;
      case 3:
        frame.is_text = !frame.is_text;
        break;
      case 4:
        frame.bytes.clear();
        break;
      default:
        damage_frame(frame, form, dice);
        break;
    }
    lines[at] = line_of(questions, std::move(frame));
  }
  return to_text(*read, true);
}

void add_answers_of_protocols(std::vector<Kind>& kinds) {
  for (const Protocol protocol : all_protocols()) {
    std::vector<Sample> samples;
    for (const RecordedServer& recorded : kRecordedServers) {
      if (recorded.protocol == protocol)
        samples.push_back({recorded.file(), text_of(recorded.path())});
    }
    kinds.push_back({row_of(protocol).word.data(), std::move(samples),
                     [](const Given& file) -> Status {
                       PROBE_ASSIGN(const Transcript said, parse_transcript(file.bytes, file.name));
                       PROBE_ASSIGN(const auto listener, play(said, "127.0.0.1", "0"));
                       PROBE_ASSIGN(
                           const ServerChoice choice,
                           choice_at(listener->port(), recorded_as(file.name), file.is_whole));
                       return converse(choice);
                     },
                     [](std::string bytes, std::uint64_t seed) {
                       return damaged_transcript(bytes, false, seed);
                     }});
  }
}

// What carries messages: a line each `asked AT WHAT NUMBER` or `answered ...`, of the bytes on
// their way.
std::string stream_damages(std::uint64_t seed) {
  Dice dice(seed ^ 0x85ebca6b);
  std::string lines;
  for (std::size_t count = 1 + dice.below(3); count > 0; --count) {
    const std::size_t within = std::size_t{4} << dice.below(12);
    lines += (dice.below(3) == 0 ? "asked " : "answered ") + std::to_string(dice.below(within)) +
             " " + std::to_string(dice.below(StreamDamage::kWhats)) + " " +
             std::to_string(dice.below(1 << 16)) + "\n";
  }
  return lines;
}
std::vector<StreamDamage> damages_of(const std::string& lines) {
  std::vector<StreamDamage> damages;
  std::istringstream in(lines);
  std::string side;
  std::size_t at = 0, what = 0, number = 0;
  while (in >> side >> at >> what >> number)
    damages.push_back({side == "asked", at, static_cast<StreamDamage::What>(what), number});
  return damages;
}

void add_streams(std::vector<Kind>& kinds) {
  constexpr std::pair<const char*, const char*> kCarriers[] = {
      {"websocket", "openpi"}, {"http", "openvla"}, {"zmq", "gr00t_n1.6"}, {"grpc", "lerobot"}};
  for (const auto& [carrier, file] : kCarriers) {
    kinds.push_back({carrier,
                     {{std::string(file) + ".transcript", ""}},
                     [](const Given& given) -> Status {
                       const RecordedServer& recorded = recorded_as(given.name);
                       PROBE_ASSIGN(const Transcript said,
                                    parse_transcript(text_of(recorded.path()), ""));
                       PROBE_ASSIGN(const auto listener, play(said, "127.0.0.1", "0"));
                       const DamagingProxy proxy(listener->port(), damages_of(given.bytes));
                       PROBE_ASSIGN(const ServerChoice choice,
                                    choice_at(proxy.port(), recorded, given.is_whole));
                       return converse(choice);
                     },
                     [](const std::string&, std::uint64_t seed) { return stream_damages(seed); }});
  }
}

// Says the same to each that comes, whatever it was asked.
class SaysOneThing {
 public:
  explicit SaysOneThing(std::string bytes) : bytes_(std::move(bytes)) {
    thread_ = std::thread([this] { run(); });
  }
  ~SaysOneThing() {
    ::shutdown(listener_.socket(), SHUT_RDWR);  // wakes accept()
    thread_.join();
  }
  std::string port() const { return listener_.port(); }

 private:
  void run() {
    while (true) {
      const Descriptor taken = listener_.accept();
      if (*taken < 0) return;
      std::string asked(4096, '\0');
      if (::recv(*taken, asked.data(), asked.size(), 0) <= 0) continue;
      send_all(*taken, bytes_);
      ::shutdown(*taken, SHUT_WR);
      while (::recv(*taken, asked.data(), asked.size(), 0) > 0) {
      }
    }
  }

  LocalListener listener_;
  std::string bytes_;
  std::thread thread_;
};

void add_http(std::vector<Kind>& kinds) {
  const std::vector<Sample> samples = {
      {"length",
       "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: "
       "13\r\n\r\n[0.1,0,0,0,1]"},
      {"chunked",
       "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\nTrailer: X-Sum\r\n\r\n"
       "5;name=\"v\"\r\n[0.1,\r\n8\r\n0,0,0,1]\r\n0\r\nX-Sum: 13\r\n\r\n"},
      {"interim", "HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n[]"},
      {"moved",
       "HTTP/1.1 302 Found\r\nLocation: https://127.0.0.1:9/x?y=1\r\nContent-Length: 0\r\n\r\n"},
      {"busy",
       "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 2\r\nConnection: close\r\n\r\nlater"},
      {"until_closed", "HTTP/1.0 200 OK\r\nServer: x\r\n\r\n[0.1]"},
      {"multipart",
       "HTTP/1.1 200 OK\r\nContent-Type: multipart/mixed; boundary=b\r\nContent-Length: 58\r\n\r\n"
       "--b\r\nContent-Type: application/json\r\n\r\n[0.1,0,0,0]\r\n--b--\r\n"}};
  kinds.push_back({"http answer", samples, [](const Given& file) -> Status {
                     const SaysOneThing server(file.bytes);
                     wire::HttpOptions options;
                     options.timeout = file.is_whole ? kPatient : kShort;
                     options.largest_body = kLargestAnswer;
                     wire::HttpConnection kept({"127.0.0.1", server.port(), "/", {}}, options);
                     wire::HttpRequest post;
                     post.method = "POST";
                     post.body = "{}";
                     PROBE_TRY(status_of(kept.exchange(post)));
                     return status_of(kept.exchange({}));
                   }});
}

Result<std::unique_ptr<wire::Listener>> reference_server(Protocol protocol) {
  ServeOptions options;
  PROBE_ASSIGN(options.policy, serve_digest());
  return serve(protocol, options);
}

// The questions of the first connection, sent one after the other to our own server.
Status ask_frames(const Transcript& asked, const std::string& port, Duration wait) {
  const wire::Endpoint server{"127.0.0.1", port, "/", {}};
  const ProtocolRow& row = row_of(asked.protocol);
  std::unique_ptr<wire::WebSocket> socket;
  std::unique_ptr<wire::ZmqRequester> requester;
  std::unique_ptr<wire::GrpcChannel> channel;
  if (row.carrier == Carrier::kWebSocket) {
    PROBE_ASSIGN(socket, wire::WebSocket::connect(server));
  }
  if (row.carrier == Carrier::kZmq) {
    PROBE_ASSIGN(requester, wire::ZmqRequester::create(server));
  }
  if (row.carrier == Carrier::kGrpc) {
    PROBE_ASSIGN(channel, wire::GrpcChannel::connect(server));
  }
  for (const Line& line : asked.connections.front()) {
    if (!line.is_question) continue;
    switch (row.carrier) {
      case Carrier::kWebSocket:
        PROBE_TRY(socket->send(line.frame.bytes, wait));
        // Some have no answer.
        while (socket->awaits_message(Duration{20})) PROBE_TRY(status_of(socket->receive(wait)));
        break;
      case Carrier::kHttp: {
        wire::HttpRequest post;
        post.method = "POST";
        post.path = row.path;
        post.body.assign(line.frame.bytes.begin(), line.frame.bytes.end());
        PROBE_TRY(status_of(wire::http_exchange(server, post, {kPatient, wait, kLargestAnswer})));
        break;
      }
      case Carrier::kZmq:
        PROBE_TRY(status_of(requester->ask(line.frame.bytes, wait)));
        break;
      case Carrier::kGrpc: {
        PROBE_ASSIGN(const wire::GrpcCall call, wire::call_of(line.frame));
        PROBE_TRY(status_of(channel->call(call, wait)));
        break;
      }
    }
  }
  return {};
}

// A conversation with our own server with all that was asked, but for what repeats itself.
Status record_questions(Protocol protocol, const fs::path& file) {
  PROBE_ASSIGN(const auto server, reference_server(protocol));
  ServeOptions options;
  PROBE_ASSIGN(ServerChoice choice,
               choose_server(protocol, "//127.0.0.1:" + server->port() + "?" +
                                           options_for_served(protocol, options)));
  for (ImageRule& image : choice.profile.images) image.width = image.height = 16;
  PROBE_ASSIGN(Transcript said, record(choice));
  said.connections.resize(1);
  auto& lines = said.connections.front();
  lines.resize(std::min<std::size_t>(lines.size(), 10));
  write_text(file, to_text(said, true));
  return {};
}

void add_questions(std::vector<Kind>& kinds, const fs::path& work) {
  const fs::path made = work / "questions";
  fs::create_directories(made);
  make_apart("questions to policy servers", [&]() -> Status {
    for (const Protocol protocol : all_protocols())
      PROBE_TRY(
          record_questions(protocol, made / (std::string(row_of(protocol).word) + ".transcript")));
    return {};
  });
  kinds.push_back({"questions", files_in(made, ".transcript", std::size_t{1} << 20),
                   [](const Given& file) -> Status {
                     PROBE_ASSIGN(const Transcript asked, parse_transcript(file.bytes, file.name));
                     PROBE_ASSIGN(const auto server, reference_server(asked.protocol));
                     return ask_frames(asked, server->port(), file.is_whole ? kPatient : kShort);
                   },
                   [](std::string bytes, std::uint64_t seed) {
                     return damaged_transcript(bytes, true, seed);
                   }});
}

}  // namespace

void add_conversations(std::vector<Kind>& kinds, const fs::path& work) {
  const std::size_t before = kinds.size();
  add_answers_of_protocols(kinds);
  add_streams(kinds);
  add_http(kinds);
  add_questions(kinds, work);
  for (std::size_t i = before; i < kinds.size(); ++i) kinds[i].waits = true;
}

}  // namespace probe::campaign
