// Messages of policy servers and of models that are asked, by what reads their bytes alone.
#include "runtime/ask/chat_message.h"
#include "runtime/servers/protocols/gr00t.h"
#include "runtime/servers/protocols/lerobot_messages.h"
#include "runtime/servers/protocols/openvla.h"
#include "runtime/servers/protocols/vlaeval_messages.h"
#include "runtime/wire/json.h"
#include "runtime/wire/msgpack.h"
#include "runtime/wire/npy.h"
#include "runtime/wire/pickle_arrays.h"
#include "tests/campaigns/kinds.h"
#include "tests/runtime/wire/pickle_samples.h"

namespace probe::campaign {
namespace {

using namespace servers;

constexpr std::size_t kLargestArray = std::size_t{1} << 24;  // bytes

wire::Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string of_msgpack(std::string bytes, std::uint64_t seed) {
  return damaged(std::move(bytes), Form::kMsgpack, seed);
}
std::string of_json(std::string bytes, std::uint64_t seed) {
  return damaged(std::move(bytes), Form::kJson, seed);
}

wire::Array actions() {
  return wire::array_f64({2, 7}, {0.1, -0.2, 0.3, 0, 0.5, -0.6, 1, 0, 0, 0, 0, 0, 0, -1});
}

std::string answer() {
  return R"({"actions":[[0.1,-0.2,0.3,0,0.5,-0.6,1],[0,0,0,0,0,0,-1]],"ok":true,"why":null,"text":"é"})";
}

Status action_answer(const wire::Value& value) {
  const wire::Value* const found = value.find("actions");
  return status_of(to_actions(found == nullptr ? value : *found));
}

void add_trees(std::vector<Kind>& kinds) {
  const auto value = wire::from_json(answer());
  kinds.push_back(
      {"msgpack",
       {{"answer", text_of(wire::to_msgpack(*value, wire::ArrayStyle{}))}},
       [](const Given& file) { return status_of(wire::from_msgpack(octets(file.bytes))); },
       of_msgpack});
  kinds.push_back({"json", {{"answer.json", answer()}}, [](const Given& file) {
                     return status_of(wire::from_json(file.bytes));
                   }});
  std::vector<Sample> pickles;
  for (const wire::PickleSample& sample : wire::kPickleSamples) {
    std::string bytes;
    for (std::string_view hex = sample.hex; hex.size() >= 2; hex.remove_prefix(2))
      bytes += static_cast<char>(std::stoi(std::string(hex.substr(0, 2)), nullptr, 16));
    pickles.push_back({sample.name, bytes});
  }
  kinds.push_back({"pickle", std::move(pickles), [](const Given& file) -> Status {
                     PROBE_ASSIGN(const wire::Pickle read,
                                  wire::read_pickle(octets(file.bytes), wire::array_globals()));
                     wire::describe(read, read.top());
                     return status_of(wire::read_array(read, read.top(), kLargestArray));
                   }});
  kinds.push_back(
      {"npy",
       {{"a.npy", text_of(wire::to_npy(actions()))},
        {"b.npy", text_of(wire::to_npy(wire::array_u8({2, 1, 3}, {1, 2, 3, 4, 5, 6})))}},
       [](const Given& file) -> Status {
         const wire::Bytes bytes = bytes_of(file.bytes);
         (void)wire::texts_from_npy(bytes);
         return status_of(wire::from_npy(bytes));
       }});
}

void add_answers_of_servers(std::vector<Kind>& kinds) {
  kinds.push_back({"openpi answer",
                   {{"answer", text_of(wire::to_msgpack(
                                   wire::Map{{"actions", actions()},
                                             {"server_timing", wire::Map{{"infer_ms", 1.5}}}},
                                   wire::ArrayStyle::kBinKeys))}},
                   [](const Given& file) -> Status {
                     PROBE_ASSIGN(const wire::Value value, wire::from_msgpack(octets(file.bytes)));
                     return action_answer(value);
                   },
                   of_msgpack});
  kinds.push_back(
      {"vlaeval answer",
       {{"answer", text_of(vlaeval::to_bytes(
                       {"action", wire::Map{{"actions", actions()}, {"note", "text"}}, 7}, 1.5))}},
       [](const Given& file) -> Status {
         PROBE_ASSIGN(const vlaeval::Message message, vlaeval::from_bytes(octets(file.bytes)));
         return action_answer(message.payload);
       },
       of_msgpack});
  wire::Map parts;
  for (const char* name : {"x", "y", "z", "roll", "pitch", "yaw", "gripper"})
    parts.emplace_back("action." + std::string(name), wire::array_f32({1, 2, 1}, {0.5, 1}));
  kinds.push_back({"gr00t answer",
                   {{"answer", text_of(wire::to_msgpack(wire::List{parts, wire::Map{}},
                                                        wire::ArrayStyle::kNpy))}},
                   [](const Given& file) -> Status {
                     PROBE_ASSIGN(const wire::Value value, wire::from_msgpack(octets(file.bytes)));
                     return status_of(gr00t_actions(value));
                   },
                   of_msgpack});
  kinds.push_back({"openvla answer",
                   {{"body.json", "[0.1,-0.2,0.3,0,0.5,-0.6,1]"},
                    {"array.json", wire::to_json(actions())},
                    {"encoded.json", wire::to_json(wire::to_json(actions()))}},
                   [](const Given& file) { return status_of(openvla_actions(file.bytes)); }});
  const wire::Array action = wire::array_f64({7}, {0.1, 0.2, 0.3, 0, 0, 0, 1});
  kinds.push_back(
      {"lerobot answer",
       {{"answer", text_of(lerobot::actions_message({{0, 7, action}, {0.03, 8, action}}))}},
       [](const Given& file) {
         return status_of(lerobot::actions_of(bytes_of(file.bytes), kLargestArray));
       }});
}

// What our own servers are sent.
void add_questions(std::vector<Kind>& kinds) {
  const wire::GrpcCall sent =
      lerobot::send_observation({1,
                                 2,
                                 {{"state.0", 0.5},
                                  {"image", wire::array_u8({2, 1, 3}, {1, 2, 3, 4, 5, 6})},
                                  {"task", "put"}}});
  const wire::GrpcCall setup =
      lerobot::send_policy({"act", "/m", "cpu", 4, {{"a", wire::List{1}}}});
  kinds.push_back(
      {"lerobot question",
       {{"call", text_of(wire::to_frame(sent).bytes)},
        {"setup", text_of(wire::to_frame(setup).bytes)}},
       [](const Given& file) -> Status {
         PROBE_ASSIGN(const wire::GrpcCall call, wire::call_of({false, bytes_of(file.bytes)}));
         return file.name == "setup" ? status_of(lerobot::setup_of(call))
                                     : status_of(lerobot::observation_of(call));
       }});
}

void add_chat(std::vector<Kind>& kinds) {
  constexpr const char* kAnswer =
      R"({"id":"x","object":"chat.completion","model":"vlm","system_fingerprint":"fp","choices":[{"index":0,"message":{"role":"assistant","content":"B","reasoning_content":"it is B"},"finish_reason":"stop","logprobs":{"content":[{"token":"B","logprob":-0.1,"bytes":[66],"top_logprobs":[{"token":"B","logprob":-0.1},{"token":" A","logprob":-2.5}]}]}}],"usage":{"prompt_tokens":12,"completion_tokens":1}})";
  constexpr const char* kParts =
      R"({"model":"vlm","choices":[{"message":{"content":[{"type":"thinking","thinking":"hm"},{"type":"text","text":"A"}]},"logprobs":null}]})";
  constexpr const char* kError =
      R"({"error":{"message":"no such model","type":"NotFound","code":404}})";
  kinds.push_back({"chat answer",
                   {{"answer.json", kAnswer}, {"parts.json", kParts}, {"error.json", kError}},
                   [](const Given& file) {
                     ask::ChatTerms terms;
                     terms.model = "vlm";
                     ask::error_words(file.bytes);
                     const auto said =
                         ask::read_chat_answer(terms, file.bytes, "application/json", 3);
                     // An error is answered as one.
                     return file.is_whole && file.name == "error.json" ? Status() : status_of(said);
                   },
                   of_json});
}

}  // namespace

void add_messages(std::vector<Kind>& kinds) {
  add_trees(kinds);
  add_answers_of_servers(kinds);
  add_questions(kinds);
  add_chat(kinds);
}

}  // namespace probe::campaign
