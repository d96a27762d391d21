// Batches of worlds.
#include <pybind11/stl.h>

#include "runtime/api/python/wrapped.h"

namespace probe::python {
namespace {

struct Batch {
  Owned<vlaprobe_batch, vlaprobe_batch_release> handle;
  std::size_t worlds = 0;
  Held<vlaprobe_batch> get() const { return handle.get("batch"); }
};

using Starts = std::vector<std::pair<std::int32_t, std::int32_t>>;

std::vector<vlaprobe_start> starts_of(const Batch& batch, const Starts& given) {
  if (given.size() != batch.worlds) throw py::value_error("there is not a start for every world");
  std::vector<vlaprobe_start> starts;
  for (const auto& [task, episode] : given) starts.push_back({task, episode});
  return starts;
}

Batch make_batch(const Plan& plan, const std::vector<std::size_t>& tasks, std::int32_t worlds,
                 std::int32_t threads, std::int32_t width, std::int32_t height, bool pictures,
                 std::int32_t autoreset) {
  vlaprobe_batch_options options{};
  options.size = sizeof options;
  options.width = width;
  options.height = height;
  options.no_pictures = pictures ? 0 : 1;
  options.worlds = worlds;
  options.threads = threads;
  options.autoreset = autoreset;
  vlaprobe_batch* batch = nullptr;
  call_free([&, handle = plan.get()](vlaprobe_error* error) {
    return vlaprobe_batch_create(handle, tasks.data(), tasks.size(), &options, &batch, error);
  });
  return {Owned<vlaprobe_batch, vlaprobe_batch_release>(batch), static_cast<std::size_t>(worlds)};
}

void reset(const Batch& batch, const std::optional<std::vector<bool>>& mask, const Starts& given) {
  const std::vector<vlaprobe_start> starts = starts_of(batch, given);
  std::vector<std::uint8_t> chosen;
  if (mask) chosen.assign(mask->begin(), mask->end());
  if (mask && chosen.size() != batch.worlds)
    throw py::value_error("the mask is not of every world");
  call_free([&, handle = batch.get()](vlaprobe_error* error) {
    return vlaprobe_batch_reset(handle, mask ? chosen.data() : nullptr, starts.data(), error);
  });
}

vlaprobe_action_space space_of(const Batch& batch) {
  vlaprobe_action_space space{};
  call([&](vlaprobe_error* error) {
    return vlaprobe_batch_action_space(batch.get(), &space, error);
  });
  return space;
}

void step(const Batch& batch, const py::handle& actions, const std::optional<Starts>& given) {
  const Numbers numbers = numbers_of(
      actions, {static_cast<py::ssize_t>(batch.worlds), space_of(batch).size}, "actions");
  std::vector<vlaprobe_start> next;
  if (given) next = starts_of(batch, *given);
  call_free([&, handle = batch.get(), data = numbers.data()](vlaprobe_error* error) {
    return vlaprobe_batch_step(handle, data, given ? next.data() : nullptr, error);
  });
}

using Get = std::int32_t (*)(const vlaprobe_batch*, std::int32_t, std::size_t, vlaprobe_array*,
                             vlaprobe_error*);

template <Get get>
py::array array_of(const py::object& self, std::int32_t field, std::size_t camera, bool copy) {
  vlaprobe_array array{};
  const Batch& batch = self.cast<const Batch&>();
  call([&](vlaprobe_error* error) { return get(batch.get(), field, camera, &array, error); });
  return copy ? copy_of(array) : view_of(array, self);
}

py::object fault_of(const Batch& batch, std::size_t world) {
  const char* fault = vlaprobe_batch_fault(batch.get(), world);
  if (fault == nullptr) return py::none();
  return py::str(fault);
}

std::vector<std::string> cameras_of(const Batch& batch) {
  std::vector<std::string> all;
  while (const char* name = vlaprobe_batch_camera(batch.get(), all.size())) all.emplace_back(name);
  return all;
}

py::list metrics_of(const Batch& batch) {
  py::list all;
  for (std::size_t i = 0; const char* name = vlaprobe_batch_metric(batch.get(), i); ++i)
    all.append(py::make_tuple(name, vlaprobe_batch_metric_is_truth(batch.get(), i) != 0));
  return all;
}

py::object instruction_of(const Batch& batch, std::size_t world) {
  const char* text = vlaprobe_batch_instruction(batch.get(), world);
  if (text == nullptr) return py::none();
  return py::str(text);
}

std::string hash_of(const Batch& batch, std::size_t world) {
  char hash[65];
  call([&](vlaprobe_error* error) { return vlaprobe_batch_hash(batch.get(), world, hash, error); });
  return hash;
}

}  // namespace

void add_batch(py::module_& module) {
  module.attr("NEXT_STEP") = static_cast<int>(VLAPROBE_NEXT_STEP);
  module.attr("SAME_STEP") = static_cast<int>(VLAPROBE_SAME_STEP);
  module.attr("DISABLED") = static_cast<int>(VLAPROBE_DISABLED);
  const auto field = [&](const char* name, vlaprobe_field number) {
    module.attr(name) = static_cast<int>(number);
  };
  field("FIELD_RGB", VLAPROBE_FIELD_RGB);
  field("FIELD_TOOL", VLAPROBE_FIELD_TOOL);
  field("FIELD_OPENNESS", VLAPROBE_FIELD_OPENNESS);
  field("FIELD_JOINTS", VLAPROBE_FIELD_JOINTS);
  field("FIELD_METRICS", VLAPROBE_FIELD_METRICS);
  field("FIELD_STEPS", VLAPROBE_FIELD_STEPS);
  field("FIELD_TASK", VLAPROBE_FIELD_TASK);
  field("FIELD_EPISODE", VLAPROBE_FIELD_EPISODE);
  field("FIELD_SUCCESS", VLAPROBE_FIELD_SUCCESS);
  field("FIELD_TERMINATED", VLAPROBE_FIELD_TERMINATED);
  field("FIELD_TRUNCATED", VLAPROBE_FIELD_TRUNCATED);
  field("FIELD_BEGUN", VLAPROBE_FIELD_BEGUN);
  field("FIELD_ENDED", VLAPROBE_FIELD_ENDED);
  field("FIELD_DECIDED", VLAPROBE_FIELD_DECIDED);
  py::class_<Batch>(module, "Batch")
      .def(py::init(&make_batch))
      .def("reset", &reset)
      .def("step", &step)
      .def("action_space", [](const Batch& b) { return told_of(space_of(b)); })
      .def("array", &array_of<&vlaprobe_batch_array>)
      .def("final", &array_of<&vlaprobe_batch_final>)
      .def("fault", &fault_of)
      .def("cameras", &cameras_of)
      .def("metrics", &metrics_of)
      .def("instruction", instruction_of)
      .def("hash", &hash_of)
      .def("close", [](Batch& b) { b.handle.close(); });
}

}  // namespace probe::python
