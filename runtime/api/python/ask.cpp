// A plan's questions to a model, and what is told of the answers.
#include <pybind11/stl.h>

#include "runtime/api/python/watched.h"

namespace probe::python {
namespace {

// What the callbacks of one call share.
struct AskCaller : Caller {
  py::object answer, progress;  // Python functions; none
};

// The dict that vlaprobe.ask() documents.
py::dict dict_of(const vlaprobe_asked& asked) {
  py::dict told;
  told["prompt"] = asked.text;
  told["picture"] = asked.rgb.data == nullptr ? py::object(py::none()) : copy_of(asked.rgb);
  told["png"] = asked.png.data == nullptr ? py::object(py::none())
                                          : py::bytes(static_cast<const char*>(asked.png.data),
                                                      static_cast<std::size_t>(asked.png.shape[0]));
  told["question"] = asked.question;
  told["task"] = asked.task;
  told["arm"] = asked.arm;
  told["episode"] = asked.episode;
  told["rotation"] = asked.rotation;
  return told;
}

void answer(void* user, const vlaprobe_asked* asked, vlaprobe_reply* reply) {
  auto* caller = static_cast<AskCaller*>(user);
  const py::gil_scoped_acquire gil;
  if (caller->raised) return vlaprobe_reply_refuse(reply, "the call was stopped");
  try {
    // (whether it is an answer, the words or the reason why there are none)
    const auto [is_answer, words] =
        caller->answer(dict_of(*asked)).cast<std::pair<bool, std::string>>();
    is_answer ? vlaprobe_reply_say(reply, words.c_str())
              : vlaprobe_reply_refuse(reply, words.c_str());
  } catch (py::error_already_set& error) {
    // sys.exit() in a callback ends the call, not a question.
    if (!error.matches(PyExc_Exception)) caller->end_with(error);
    vlaprobe_reply_refuse(reply, error.what());
  } catch (const std::exception& exception) {
    vlaprobe_reply_refuse(reply, exception.what());
  }
}

std::int32_t progress(void* user, const vlaprobe_ask_progress* told) {
  auto* caller = static_cast<AskCaller*>(user);
  const py::gil_scoped_acquire gil;
  if (caller->raised) return 1;
  try {
    py::dict row;
    row["done"] = told->done;
    row["skipped"] = told->skipped;
    row["total"] = told->total;
    if (told->question != nullptr) {
      row["question"] = told->question;
      row["task"] = told->task;
      row["episode"] = told->episode;
      row["raw"] = told->raw;
      row["right"] = told->right != 0;
      row["invalid"] =
          told->invalid == nullptr ? py::object(py::none()) : py::object(py::str(told->invalid));
    }
    caller->progress(row);
    return 0;
  } catch (py::error_already_set& error) {
    caller->end_with(error);
    return 1;
  }
}

std::int32_t is_stopped(void* user) { return static_cast<AskCaller*>(user)->stop ? 1 : 0; }

// Options as vlaprobe_ask_options names them; texts and pairs may be None.
std::string ask(const Plan& plan, const py::dict& given, py::object answers, py::object tell) {
  using Text = std::optional<std::string>;
  std::vector<Text> texts;
  for (const char* name : {"out", "model", "name", "content", "suite", "tasks", "questions", "arms",
                           "frames", "camera"})
    texts.push_back(given[name].cast<Text>());
  const auto text = [&](std::size_t i) { return texts[i] ? texts[i]->c_str() : nullptr; };
  const auto pair = [&](const char* name) {
    return given[name].cast<std::optional<std::pair<std::int32_t, std::int32_t>>>();
  };
  AskCaller caller;
  caller.answer = std::move(answers);
  caller.progress = std::move(tell);
  vlaprobe_ask_options options{};
  options.size = sizeof options;
  options.out = text(0);
  options.model = text(1);
  options.name = text(2);
  options.content = text(3);
  options.suite = text(4);
  options.tasks = text(5);
  options.questions = text(6);
  options.arms = text(7);
  options.frames = text(8);
  options.camera = text(9);
  if (const auto episodes = pair("episodes")) {
    options.has_episodes = 1;
    options.first_episode = episodes->first;
    options.last_episode = episodes->second;
  }
  if (const auto shard = pair("shard")) {
    options.shard = shard->first;
    options.shards = shard->second;
  }
  if (const auto size = pair("size")) {
    options.width = size->first;
    options.height = size->second;
  }
  options.jobs = given["jobs"].cast<std::int32_t>();
  options.has_retries = 1;
  options.retries = given["retries"].cast<std::int32_t>();
  options.has_give_up_after = 1;
  options.give_up_after = given["give_up_after"].cast<std::int32_t>();
  options.accepts_certificate = given["insecure"].cast<bool>() ? 1 : 0;
  options.if_changed = given["if_changed"].cast<std::int32_t>();
  if (!caller.answer.is_none()) options.answer = &answer;
  if (!caller.progress.is_none()) options.progress = &progress;
  options.user = &caller;
  options.stopped = &is_stopped;

  char* summary = nullptr;
  const Held<vlaprobe_plan> handle = plan.get();
  call_watched(caller, [&](vlaprobe_error* error) {
    return vlaprobe_ask(handle, &options, &summary, error);
  });
  return taken(summary);
}

std::string answers(const std::string& folder) {
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) { return vlaprobe_answers(folder.c_str(), &json, error); });
  return taken(json);
}

std::string why_answers(const std::string& folder, const std::string& task, std::int32_t episode,
                        std::int32_t seed, const std::optional<std::string>& question) {
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_why_answers(folder.c_str(), task.c_str(), episode, seed,
                                question ? question->c_str() : nullptr, &json, error);
  });
  return taken(json);
}

}  // namespace

void add_ask(py::module_& module) {
  module.def("ask", &ask);
  module.def("answers", &answers);
  module.def("why_answers", &why_answers);
}

}  // namespace probe::python
