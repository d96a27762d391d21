// Plans.
#include <pybind11/stl.h>

#include "runtime/api/python/wrapped.h"

namespace probe::python {
namespace {

const char* or_null(const std::optional<std::string>& text) {
  return text ? text->c_str() : nullptr;
}

std::string taken(char* text) {
  std::string copy(text);
  vlaprobe_free(text);
  return copy;
}

Plan compile(const std::vector<std::string>& files, const std::optional<std::string>& assets,
             const std::optional<std::string>& library, const std::optional<std::string>& suite,
             const std::optional<std::string>& tasks) {
  vlaprobe_plan_options options{};
  options.size = sizeof options;
  options.assets = or_null(assets);
  options.library = or_null(library);
  options.suite = or_null(suite);
  options.tasks = or_null(tasks);
  std::vector<const char*> paths;
  for (const std::string& file : files) paths.push_back(file.c_str());
  vlaprobe_plan* plan = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_compile(paths.data(), paths.size(), &options, &plan, error);
  });
  return {Owned<vlaprobe_plan, vlaprobe_plan_release>(plan)};
}

Plan open(const std::string& path, const std::optional<std::string>& assets) {
  vlaprobe_plan_options options{};
  options.size = sizeof options;
  options.assets = or_null(assets);
  vlaprobe_plan* plan = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_plan_open(path.c_str(), &options, &plan, error);
  });
  return {Owned<vlaprobe_plan, vlaprobe_plan_release>(plan)};
}

Plan from_bytes(const py::bytes& bytes, const std::optional<std::string>& assets) {
  vlaprobe_plan_options options{};
  options.size = sizeof options;
  options.assets = or_null(assets);
  char* data = nullptr;
  py::ssize_t size = 0;
  if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size) != 0) throw py::error_already_set();
  vlaprobe_plan* plan = nullptr;
  call_free([&](vlaprobe_error* error) {
    return vlaprobe_plan_from_bytes(data, static_cast<std::size_t>(size), &options, &plan, error);
  });
  return {Owned<vlaprobe_plan, vlaprobe_plan_release>(plan)};
}

py::tuple task_of(const Plan& plan, std::size_t index) {
  vlaprobe_task task{};
  call([&](vlaprobe_error* error) { return vlaprobe_plan_task(plan.get(), index, &task, error); });
  return py::make_tuple(task.name, task.instruction, task.baseline, task.episodes, task.horizon,
                        task.control_hz, task.cameras, task.joints);
}

py::list suites_of(const Plan& plan) {
  py::list all;
  for (std::size_t i = 0; i < vlaprobe_plan_suite_count(plan.get()); ++i) {
    vlaprobe_suite suite{};
    call([&](vlaprobe_error* error) { return vlaprobe_plan_suite(plan.get(), i, &suite, error); });
    all.append(
        py::make_tuple(suite.name, suite.prefix,
                       std::vector<std::uint32_t>(suite.tasks, suite.tasks + suite.task_count),
                       std::vector<std::uint32_t>(suite.seeds, suite.seeds + suite.seed_count)));
  }
  return all;
}

py::tuple episode_of(const Plan& plan, std::size_t task, std::int32_t index) {
  vlaprobe_episode episode{};
  call([&](vlaprobe_error* error) {
    return vlaprobe_plan_episode(plan.get(), task, index, &episode, error);
  });
  py::list placements;
  for (std::int32_t i = 0; i < episode.placements; ++i) {
    vlaprobe_placement placed{};
    call([&](vlaprobe_error* error) {
      return vlaprobe_plan_placement(plan.get(), task, index, i, &placed, error);
    });
    py::tuple position(3), rotation(4);
    for (std::size_t k = 0; k < 3; ++k) position[k] = placed.position[k];
    for (std::size_t k = 0; k < 4; ++k) rotation[k] = placed.rotation[k];
    placements.append(py::make_tuple(placed.object, position, rotation));
  }
  return py::make_tuple(episode.episode_id, episode.start_id, placements);
}

std::string json_of(const Plan& plan, std::size_t task) {
  char* json = nullptr;
  call_free([&, handle = plan.get()](vlaprobe_error* error) {
    return vlaprobe_plan_describe(handle, task, &json, error);
  });
  return taken(json);
}

std::string list_of(const Plan& plan) {
  char* json = nullptr;
  call_free([&, handle = plan.get()](vlaprobe_error* error) {
    return vlaprobe_plan_list(handle, &json, error);
  });
  return taken(json);
}

std::size_t found(const Plan& plan, const std::string& name) {
  std::size_t task = 0;
  call([&](vlaprobe_error* error) {
    return vlaprobe_plan_find_task(plan.get(), name.c_str(), &task, error);
  });
  return task;
}

py::bytes bytes_of(const Plan& plan) {
  std::size_t size = 0;
  const void* bytes = vlaprobe_plan_bytes(plan.get(), &size);
  return {static_cast<const char*>(bytes), size};
}

void load(const Plan& plan, const std::vector<std::size_t>& tasks) {
  call_free([&, handle = plan.get()](vlaprobe_error* error) {
    return vlaprobe_plan_load(handle, tasks.data(), tasks.size(), error);
  });
}

}  // namespace

void add_plan(py::module_& module) {
  py::class_<Plan>(module, "Plan")
      .def_static("compile", &compile)
      .def_static("open", &open)
      .def_static("from_bytes", &from_bytes)
      .def_property_readonly("root", [](const Plan& p) { return vlaprobe_plan_root(p.get()); })
      .def_property_readonly("assets", [](const Plan& p) { return vlaprobe_plan_assets(p.get()); })
      .def_property_readonly("warnings",
                             [](const Plan& p) { return vlaprobe_plan_warnings(p.get()); })
      .def_property_readonly("diagnostics",
                             [](const Plan& p) { return vlaprobe_plan_diagnostics(p.get()); })
      .def_property_readonly("task_count",
                             [](const Plan& p) { return vlaprobe_plan_task_count(p.get()); })
      .def("bytes", &bytes_of)
      .def("task", &task_of)
      .def("find_task", &found)
      .def("suites", &suites_of)
      .def("episode", &episode_of)
      .def("describe", &json_of)
      .def("list", &list_of)
      .def("load", &load)
      .def("forget", [](const Plan& p) { vlaprobe_plan_forget(p.get()); });
}

}  // namespace probe::python
