// Stages, and policies of ours that act in them.
#include <pybind11/stl.h>

#include "runtime/api/python/wrapped.h"

namespace probe::python {
namespace {

struct Policy {
  Owned<vlaprobe_policy, vlaprobe_policy_release> handle;
  Held<vlaprobe_policy> get() const { return handle.get("policy"); }
};

Stage make_stage(const Plan& plan, std::size_t task, std::int32_t width, std::int32_t height,
                 bool pictures) {
  vlaprobe_stage_options options{};
  options.size = sizeof options;
  options.width = width;
  options.height = height;
  options.no_pictures = pictures ? 0 : 1;
  vlaprobe_stage* stage = nullptr;
  call_free([&, handle = plan.get()](vlaprobe_error* error) {
    return vlaprobe_stage_create(handle, task, &options, &stage, error);
  });
  return {Owned<vlaprobe_stage, vlaprobe_stage_release>(stage)};
}

void reset(const Stage& stage, std::int32_t episode) {
  call_free([&, handle = stage.get()](vlaprobe_error* error) {
    return vlaprobe_stage_reset(handle, episode, error);
  });
}

vlaprobe_action_space space_of(const Stage& stage) {
  vlaprobe_action_space space{};
  call([&](vlaprobe_error* error) {
    return vlaprobe_stage_action_space(stage.get(), &space, error);
  });
  return space;
}

void step(const Stage& stage, const py::handle& action) {
  const std::int32_t size = space_of(stage).size;
  const Numbers numbers = numbers_of(action, {size}, "an action");
  call_free([handle = stage.get(), data = numbers.data(), size](vlaprobe_error* error) {
    return vlaprobe_stage_step(handle, data, static_cast<std::size_t>(size), error);
  });
}

void observe(const Stage& stage) {
  call_free([handle = stage.get()](vlaprobe_error* error) {
    return vlaprobe_stage_observe(handle, error);
  });
}

vlaprobe_state state_now(const Stage& stage) {
  vlaprobe_state state{};
  call([&](vlaprobe_error* error) { return vlaprobe_stage_state(stage.get(), &state, error); });
  return state;
}

// (episode, steps, terminated, truncated, decided, success, tool and openness (8,), joints (n,),
// metrics)
py::tuple state_of(const Stage& stage) {
  const vlaprobe_state state = state_now(stage);
  py::array_t<double> tool(8);
  for (py::ssize_t i = 0; i < 7; ++i) tool.mutable_at(i) = state.tool[i];
  tool.mutable_at(7) = state.openness;
  const auto* metrics = static_cast<const double*>(state.metrics.data);
  return py::make_tuple(state.episode, state.steps, state.terminated != 0, state.truncated != 0,
                        state.decided != 0, state.success != 0, tool, copy_of(state.joints),
                        std::vector<double>(metrics, metrics + state.metrics.shape[0]));
}

py::array objects_of(const Stage& stage) { return copy_of(state_now(stage).objects); }

py::array picture_of(const py::object& self, std::size_t camera, std::int32_t kind, bool copy) {
  vlaprobe_array array{};
  const Stage& stage = self.cast<const Stage&>();
  call([&](vlaprobe_error* error) {
    return vlaprobe_stage_picture(stage.get(), camera, kind, &array, error);
  });
  return copy ? copy_of(array) : view_of(array, self);
}

using NameAt = const char* (*)(const vlaprobe_stage*, std::size_t);
std::vector<std::string> names(const Stage& stage, NameAt name_at) {
  std::vector<std::string> all;
  while (const char* name = name_at(stage.get(), all.size())) all.emplace_back(name);
  return all;
}

py::list cameras_of(const Stage& stage) {
  py::list all;
  for (std::size_t i = 0; const char* name = vlaprobe_stage_camera(stage.get(), i); ++i) {
    std::int32_t height = 0, width = 0;
    call([&](vlaprobe_error* error) {
      return vlaprobe_stage_picture_size(stage.get(), i, &height, &width, error);
    });
    all.append(py::make_tuple(name, height, width));
  }
  return all;
}

py::list metrics_of(const Stage& stage) {
  py::list all;
  for (std::size_t i = 0; const char* name = vlaprobe_stage_metric(stage.get(), i); ++i)
    all.append(py::make_tuple(name, vlaprobe_stage_metric_is_truth(stage.get(), i) != 0));
  return all;
}

std::string instruction_of(const Stage& stage) { return vlaprobe_stage_instruction(stage.get()); }

std::string hash_of(const Stage& stage) {
  char hash[65];
  call([&](vlaprobe_error* error) { return vlaprobe_stage_hash(stage.get(), hash, error); });
  return hash;
}

py::bytes saved(const Stage& stage) {
  const void* bytes = nullptr;
  std::size_t size = 0;
  call([&](vlaprobe_error* error) {
    return vlaprobe_stage_save(stage.get(), &bytes, &size, error);
  });
  return {static_cast<const char*>(bytes), size};
}

void restore(const Stage& stage, const py::bytes& bytes) {
  char* data = nullptr;
  py::ssize_t size = 0;
  if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size) != 0) throw py::error_already_set();
  call_free([&, handle = stage.get()](vlaprobe_error* error) {
    return vlaprobe_stage_restore(handle, data, static_cast<std::size_t>(size), error);
  });
}

Policy make_policy(const std::string& text) {
  vlaprobe_policy* policy = nullptr;
  call_free(
      [&](vlaprobe_error* error) { return vlaprobe_policy_create(text.c_str(), &policy, error); });
  return {Owned<vlaprobe_policy, vlaprobe_policy_release>(policy)};
}

void begin(const Policy& policy, const Stage& stage, std::int32_t seed) {
  call_free([handle = policy.get(), world = stage.get(), seed](vlaprobe_error* error) {
    return vlaprobe_policy_begin(handle, world, seed, error);
  });
}

py::array_t<double> act(const Policy& policy, const Stage& stage) {
  py::array_t<double> action(space_of(stage).size);
  call_free([handle = policy.get(), world = stage.get(), data = action.mutable_data(),
             size = static_cast<std::size_t>(action.size())](vlaprobe_error* error) {
    return vlaprobe_policy_act(handle, world, data, size, error);
  });
  return action;
}

}  // namespace

void add_stage(py::module_& module) {
  module.attr("RGB") = static_cast<int>(VLAPROBE_RGB);
  module.attr("DEPTH") = static_cast<int>(VLAPROBE_DEPTH);
  module.attr("SEGMENTATION") = static_cast<int>(VLAPROBE_SEGMENTATION);
  py::class_<Stage>(module, "Stage")
      .def(py::init(&make_stage))
      .def("reset", &reset)
      .def("step", &step)
      .def("action_space", [](const Stage& s) { return told_of(space_of(s)); })
      .def("observe", &observe)
      .def("state", &state_of)
      .def("objects", &objects_of)
      .def("picture", &picture_of)
      .def("cameras", &cameras_of)
      .def("metrics", &metrics_of)
      .def("joint_names", [](const Stage& s) { return names(s, &vlaprobe_stage_joint); })
      .def("object_names", [](const Stage& s) { return names(s, &vlaprobe_stage_object); })
      .def("body_names", [](const Stage& s) { return names(s, &vlaprobe_stage_body); })
      .def("instruction", instruction_of)
      .def("hash", &hash_of)
      .def("save", &saved)
      .def("restore", &restore)
      .def("close", [](Stage& s) { s.handle.close(); });
  py::class_<Policy>(module, "Policy")
      .def(py::init(&make_policy))
      .def("begin", &begin)
      .def("act", &act)
      .def("close", [](Policy& p) { p.handle.close(); });
}

}  // namespace probe::python
