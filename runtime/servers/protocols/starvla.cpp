// starVLA's WebSocket server (deployment/model_server/tools/websocket_policy_server.py): openpi's
// framing, whose maps are the arguments of predict_action: {"examples": [{"image": [...],
// "lang"}]}, answered under "data" and with the question's number. An error is a map like any
// other. Servers keep nothing between questions.
#include <array>

#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/openpi_connection.h"
#include "runtime/servers/protocols/served_sides.h"

namespace probe::servers {
namespace {

class StarVla : public Transport {
 public:
  StarVla(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), connection_(server) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    return check_key();
  }
  void close() override { connection_.close(); }
  Status listen(wire::Duration wait) override { return connection_.listen(wait); }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    const Request* one[] = {&request};
    PROBE_ASSIGN(const wire::Value actions, predict(one, deadlines));
    return to_actions(actions);
  }

  // predict_action answers as many examples as it is given: [examples, actions, 7].
  Result<BatchAnswers> ask_all(std::span<const Request* const> requests,
                               const Deadlines& deadlines) override {
    PROBE_ASSIGN(const wire::Value actions, predict(requests, deadlines));
    const auto* array = actions.as<wire::Array>();
    if (array == nullptr || array->shape.size() != 3 || array->shape[0] < 0) {
      return bad("expected an array " + std::to_string(requests.size()) + " x N x 7; got " +
                 wire::describe(actions));
    }
    PROBE_TRY(wire::check_fit(*array));
    PROBE_TRY(check_batch(static_cast<std::size_t>(array->shape[0]), requests.size()));
    const std::size_t size = array->bytes.size() / requests.size();
    BatchAnswers all;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      wire::Array item{array->dtype, {array->shape[1], array->shape[2]}, {}};
      const auto* begin = array->bytes.data() + i * size;
      item.bytes.assign(begin, begin + size);
      auto read = to_actions(std::move(item));
      if (!read) read = of_item(read.failure(), i, requests.size());
      all.push_back(std::move(read));
    }
    return all;
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(metadata_); }

 private:
  wire::Map example(const Request& request) const {
    wire::List images;
    for (const RequestImage& image : request.images) images.emplace_back(image.pixels);
    wire::Map map{{"image", std::move(images)}, {profile_.prompt_key, request.prompt}};
    if (!request.state.empty()) {
      // A history of one.
      wire::Array state = state_array(profile_, request.state);
      state.shape.insert(state.shape.begin(), 1);
      map.emplace_back(profile_.state_key, std::move(state));
    }
    return map;
  }

  Result<wire::Value> predict(std::span<const Request* const> requests,
                              const Deadlines& deadlines) {
    wire::List examples;
    for (const Request* request : requests) {
      examples.emplace_back(example(*request));
      PROBE_TRY(check_distinct_keys(examples.back()));
    }
    // As starVLA's own evaluation in SimplerEnv asks (model2simpler_interface.py).
    wire::Map map{{"examples", std::move(examples)},
                  {"do_sample", false},
                  {"use_ddim", true},
                  {"num_ddim_steps", 10}};
    if (!profile_.unnorm_key.empty()) map.emplace_back("unnorm_key", profile_.unnorm_key);
    const std::string number = std::to_string(++asked_);
    wire::Map question{{"type", "infer"}, {"request_id", number}, {"payload", std::move(map)}};
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(std::move(question), deadlines.answer));
    PROBE_TRY(check_number(answer, number));
    if (const wire::Value* error = answer.find("error")) {
      const wire::Value* message = error->find("message");
      const auto* text = message == nullptr ? nullptr : message->as<std::string>();
      return answered("the server failed: " +
                      (text == nullptr ? wire::describe(*error) : last_lines(*text)));
    }
    const wire::Value* data = answer.find("data");
    const wire::Value* actions = data == nullptr ? nullptr : data->find("actions");
    if (actions == nullptr) {
      return bad("expected a map with `data`, a map with `actions`; got " +
                 wire::describe(data == nullptr ? answer : *data));
    }
    return *actions;
  }

  // Answers say which question they are to; those of servers that do not are believed.
  static Status check_number(const wire::Value& answer, const std::string& number) {
    const wire::Value* said = answer.find("request_id");
    if (said == nullptr) return {};
    const auto* text = said->as<std::string>();
    if (text != nullptr && *text == number) return {};
    return bad("an answer to another question: expected request_id `" + number + "`, got " +
               (text == nullptr ? wire::describe(*said) : "`" + last_lines(*text) + "`"));
  }

  // Its statistics by name, which it lists; one of another data set would be metres of another
  // size.
  Status check_key() const {
    const wire::Value* keys = metadata_.find("available_unnorm_keys");
    const auto* known = keys == nullptr ? nullptr : keys->as<wire::List>();
    if (known == nullptr) return {};
    std::string names;
    for (const wire::Value& name : *known) {
      const auto* text = name.as<std::string>();
      if (text == nullptr) continue;
      if (*text == profile_.unnorm_key) return {};
      names += (names.empty() ? "`" : ", `") + last_lines(*text) + "`";
    }
    if (profile_.unnorm_key.empty() && known->size() <= 1) return {};
    return Failure{Fault::kUsage,
                   "the server has statistics of " + names +
                       ", and the profile's `unnorm_key` is " +
                       (profile_.unnorm_key.empty() ? "none" : "`" + profile_.unnorm_key + "`"),
                   ""};
  }

  Profile profile_;
  OpenpiConnection connection_;
  wire::Value metadata_;
  std::uint64_t asked_ = 0;  // questions, of all connections
};

Result<std::unique_ptr<Transport>> make_starvla(const Profile& profile,
                                                const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<StarVla>(profile, server));
}

// Pictures go in a list, in the profile's order, whatever their keys.
std::vector<KeyUse> starvla_key_uses(const Profile& profile) {
  std::vector<KeyUse> uses = image_key_uses(profile);
  for (KeyUse& use : uses) use.map = "image";
  if (profile.state_layout != StateLayout::kNone) uses.push_back(state_key_use(profile.state_key));
  uses.push_back(prompt_key_use(profile));
  return uses;
}

constexpr std::array<std::string_view, 1> kStarVlaKeys = {"image"};

}  // namespace

constinit const ProtocolRow starvla_row{
    .word = "starvla",
    .argument = "//HOST:PORT",
    .meaning = "a starVLA server",
    .port = "10093",
    .options = {},
    .fixed_keys = kStarVlaKeys,
    .key_uses = starvla_key_uses,
    .make = make_starvla,
    .serve = serve_starvla,
    // As rendered: an episode is known by its first picture.
    .served_options = "&chunk.length=any&chunk.use=all&image=first%20-%3E%20image",
    .batches = Batches::kOneMessage,
};

}  // namespace probe::servers
