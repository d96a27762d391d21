// Runs, and what is told of them.
#include <pybind11/stl.h>

#include <cstring>

#include "runtime/api/python/watched.h"

namespace probe::python {
namespace {

// What the callbacks of one run share.
struct RunCaller : Caller {
  py::object answer, progress;  // Python functions; none
};

template <typename T, typename Of>
py::array_t<T> column(const vlaprobe_question* questions, std::size_t count, Of of) {
  py::array_t<T> numbers(static_cast<py::ssize_t>(count));
  for (std::size_t i = 0; i < count; ++i)
    numbers.mutable_data()[i] = static_cast<T>(of(questions[i]));
  return numbers;
}

// The dict that vlaprobe.evaluate() documents.
py::dict batch_of(const vlaprobe_question* questions, std::size_t count) {
  const auto n = static_cast<py::ssize_t>(count);
  py::dict pixels;
  for (std::size_t camera = 0; camera < questions[0].picture_count; ++camera) {
    const vlaprobe_camera_picture& first = questions[0].pictures[camera];
    const auto size = static_cast<std::size_t>(first.rgb.shape[0] * first.rgb.shape[1] * 3);
    py::array_t<std::uint8_t> pictures({n, static_cast<py::ssize_t>(first.rgb.shape[0]),
                                        static_cast<py::ssize_t>(first.rgb.shape[1]),
                                        py::ssize_t{3}});
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(pictures.mutable_data() + i * size, questions[i].pictures[camera].rgb.data, size);
    }
    pixels[first.camera] = std::move(pictures);
  }
  py::array_t<double> tools({n, py::ssize_t{8}});
  const auto joint_count = static_cast<std::size_t>(questions[0].joints.shape[0]);
  py::array_t<double> joints({n, static_cast<py::ssize_t>(joint_count)});
  py::list prompts, tasks;
  for (std::size_t i = 0; i < count; ++i) {
    double* tool = tools.mutable_data() + i * 8;
    std::memcpy(tool, questions[i].tool, sizeof questions[i].tool);
    tool[7] = questions[i].openness;
    std::memcpy(joints.mutable_data() + i * joint_count, questions[i].joints.data,
                joint_count * sizeof(double));
    prompts.append(questions[i].instruction);
    tasks.append(questions[i].task);
  }
  using Question = vlaprobe_question;
  py::dict batch;
  batch["pixels"] = std::move(pixels);
  batch["agent_pos"] = std::move(tools);
  batch["joints"] = std::move(joints);
  batch["prompt"] = std::move(prompts);
  batch["task"] = std::move(tasks);
  batch["world"] =
      column<std::int32_t>(questions, count, [](const Question& q) { return q.world; });
  batch["episode"] =
      column<std::int32_t>(questions, count, [](const Question& q) { return q.episode; });
  batch["seed"] = column<std::int32_t>(questions, count, [](const Question& q) { return q.seed; });
  batch["step"] = column<std::int32_t>(questions, count, [](const Question& q) { return q.step; });
  batch["horizon"] =
      column<std::int32_t>(questions, count, [](const Question& q) { return q.horizon; });
  batch["action_size"] = questions[0].action_size;
  batch["draw_seed"] =
      column<std::uint64_t>(questions, count, [](const Question& q) { return q.draw_seed; });
  return batch;
}

void refuse_all(vlaprobe_refusals* refusals, std::size_t count, const std::string& why) {
  for (std::size_t i = 0; i < count; ++i) vlaprobe_refuse(refusals, i, why.c_str());
}

void act(void* user, const vlaprobe_question* questions, std::size_t count, double* actions,
         vlaprobe_refusals* refusals) {
  auto* caller = static_cast<RunCaller*>(user);
  const py::gil_scoped_acquire gil;
  try {
    // An array (n, action_size), or the reason why there is none.
    const py::object answer = caller->answer(batch_of(questions, count));
    if (py::isinstance<py::str>(answer))
      return refuse_all(refusals, count, answer.cast<std::string>());
    const std::size_t size = questions[0].action_size;
    const Numbers numbers = numbers_of(
        answer, {static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(size)}, "actions");
    std::memcpy(actions, numbers.data(), count * size * sizeof(double));
  } catch (py::error_already_set& error) {
    // sys.exit() in a callback ends the run, not an episode.
    if (!error.matches(PyExc_Exception)) caller->end_with(error);
    refuse_all(refusals, count, error.what());
  } catch (const std::exception& exception) {
    refuse_all(refusals, count, exception.what());
  }
}

std::int32_t is_stopped(void* user) { return static_cast<RunCaller*>(user)->stop ? 1 : 0; }

std::int32_t progress(void* user, const vlaprobe_progress* told) {
  auto* caller = static_cast<RunCaller*>(user);
  const py::gil_scoped_acquire gil;
  if (caller->raised) return 1;
  try {
    py::dict row;
    row["done"] = told->done;
    row["skipped"] = told->skipped;
    row["total"] = told->total;
    if (told->task != nullptr) {
      row["task"] = told->task;
      row["episode"] = told->episode;
      row["seed"] = told->seed;
      row["steps"] = told->steps;
      row["success"] = told->success != 0;
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

// Options as vlaprobe_run_options names them; texts may be None.
std::string run(const Plan& plan, const py::dict& given, py::object answer, py::object tell) {
  const auto text = [&](const char* name) -> std::optional<std::string> {
    return given[name].cast<std::optional<std::string>>();
  };
  const auto out = text("out"), policy = text("policy"), name = text("name"),
             content = text("content"), suite = text("suite"), tasks = text("tasks"),
             until = text("until");
  const auto or_null = [](const std::optional<std::string>& words) {
    return words ? words->c_str() : nullptr;
  };
  const auto seeds = given["seeds"].cast<std::vector<std::int32_t>>();
  const auto episodes =
      given["episodes"].cast<std::optional<std::pair<std::int32_t, std::int32_t>>>();
  RunCaller caller;
  caller.answer = std::move(answer);
  caller.progress = std::move(tell);
  vlaprobe_run_options options{};
  options.size = sizeof options;
  options.out = or_null(out);
  options.policy = or_null(policy);
  options.name = or_null(name);
  options.content = or_null(content);
  options.suite = or_null(suite);
  options.tasks = or_null(tasks);
  options.originals = given["originals"].cast<bool>() ? 1 : 0;
  options.has_episodes = episodes ? 1 : 0;
  if (episodes) {
    options.first_episode = episodes->first;
    options.last_episode = episodes->second;
  }
  options.seeds = seeds.data();
  options.seed_count = seeds.size();
  options.jobs = given["jobs"].cast<std::int32_t>();
  options.if_changed = given["if_changed"].cast<std::int32_t>();
  options.videos = given["videos"].cast<std::int32_t>();
  if (!caller.answer.is_none()) options.act = &act;
  options.draws = given["draws"].cast<bool>() ? 1 : 0;
  options.batch = given["batch"].cast<std::int32_t>();
  options.gather_s = given["gather_s"].cast<double>();
  if (!caller.progress.is_none()) options.progress = &progress;
  options.user = &caller;
  options.stopped = &is_stopped;
  options.until = or_null(until);

  char* summary = nullptr;
  const Held<vlaprobe_plan> handle = plan.get();
  call_watched(caller, [&](vlaprobe_error* error) {
    return vlaprobe_run(handle, &options, &summary, error);
  });
  return taken(summary);
}

std::string results(const std::string& folder) {
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) { return vlaprobe_results(folder.c_str(), &json, error); });
  return taken(json);
}

std::string why(const std::string& folder, const std::string& task, std::int32_t episode,
                std::int32_t seed, const std::optional<std::string>& metric) {
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_why(folder.c_str(), task.c_str(), episode, seed,
                        metric ? metric->c_str() : nullptr, &json, error);
  });
  return taken(json);
}

std::string compare(const std::string& folder, const std::string& other,
                    const std::vector<std::string>& metrics) {
  std::vector<const char*> names;
  for (const std::string& metric : metrics) names.push_back(metric.c_str());
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_compare(folder.c_str(), other.c_str(), names.data(), names.size(), &json,
                            error);
  });
  return taken(json);
}

std::string report(const std::vector<std::string>& folders, const std::string& out,
                   const std::optional<std::string>& title,
                   const std::optional<std::string>& floors, bool traces, std::int32_t jobs) {
  std::vector<const char*> paths;
  for (const std::string& folder : folders) paths.push_back(folder.c_str());
  vlaprobe_report_options options{};
  options.size = sizeof options;
  options.out = out.c_str();
  options.title = title ? title->c_str() : nullptr;
  options.floors = floors ? floors->c_str() : nullptr;
  options.no_traces = traces ? 0 : 1;
  options.jobs = jobs;
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_report(paths.data(), paths.size(), &options, &json, error);
  });
  return taken(json);
}

std::string replay(const std::string& folder, const std::string& task, std::int32_t episode,
                   std::int32_t seed, const std::optional<std::string>& assets,
                   const std::optional<std::string>& video, const std::optional<std::string>& png,
                   std::int32_t png_step, const std::optional<std::string>& camera, bool verify) {
  const auto or_null = [](const std::optional<std::string>& words) {
    return words ? words->c_str() : nullptr;
  };
  vlaprobe_replay_options options{};
  options.size = sizeof options;
  options.assets = or_null(assets);
  options.video = or_null(video);
  options.png = or_null(png);
  options.png_step = png_step;
  options.camera = or_null(camera);
  options.no_verify = verify ? 0 : 1;
  char* json = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_replay(folder.c_str(), task.c_str(), episode, seed, &options, &json, error);
  });
  return taken(json);
}

}  // namespace

void add_run(py::module_& module) {
  module.def("run", &run);
  module.def("results", &results);
  module.def("why", &why);
  module.def("compare", &compare);
  module.def("report", &report);
  module.def("replay", &replay);
}

}  // namespace probe::python
