// The extension module vlaprobe._vlaprobe: thin, one class a handle. The package says it in Python.
#include "runtime/api/python/wrapped.h"

namespace probe::python {
namespace {

py::dtype dtype_of(std::int32_t type) {
  switch (type) {
    case VLAPROBE_U8:
      return py::dtype::of<std::uint8_t>();
    case VLAPROBE_U16:
      return py::dtype::of<std::uint16_t>();
    case VLAPROBE_I32:
      return py::dtype::of<std::int32_t>();
    case VLAPROBE_F32:
      return py::dtype::of<float>();
    default:
      return py::dtype::of<double>();
  }
}

std::vector<py::ssize_t> shape_of(const vlaprobe_array& array) {
  return {array.shape, array.shape + array.rank};
}

std::string text_of(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

}  // namespace

void Error::raise() const {
  const auto text = [](const char* words) { return words == nullptr ? "" : words; };
  const py::object exception =
      py::module_::import("vlaprobe.errors")
          .attr("_from_code")(vlaprobe_code_word(error_.code), text(error_.message),
                              text(error_.where), text(error_.diagnostics));
  PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
  throw py::error_already_set();
}

void raise_closed(const char* what) {
  const py::object type = py::module_::import("vlaprobe.errors").attr("ClosedError");
  PyErr_SetString(type.ptr(), (std::string("the ") + what + " was closed").c_str());
  throw py::error_already_set();
}

py::array view_of(const vlaprobe_array& array, const py::handle& owner) {
  py::array view(dtype_of(array.type), shape_of(array), {}, array.data, owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

py::array copy_of(const vlaprobe_array& array) {
  return py::array(dtype_of(array.type), shape_of(array), {}, array.data);
}

py::tuple told_of(const vlaprobe_action_space& space) {
  return py::make_tuple(space.kind, copy_of(space.low), copy_of(space.high));
}

Numbers numbers_of(const py::handle& given, const std::vector<py::ssize_t>& shape,
                   const char* what) {
  const std::string wanted =
      std::string(what) + " is an array of numbers of the shape " + text_of(shape);
  // What has memory of its own elsewhere, as a tensor on a GPU has, numpy would wrap as an object.
  const py::array plain = py::array::ensure(given);
  if (!plain || std::string("biuf").find(plain.dtype().kind()) == std::string::npos) {
    PyErr_Clear();
    throw py::type_error(wanted + "; found " +
                         std::string(py::str(py::type::of(given).attr("__name__"))));
  }
  const std::vector<py::ssize_t> found(plain.shape(), plain.shape() + plain.ndim());
  if (found != shape) throw py::value_error(wanted + "; found " + text_of(found));
  return Numbers::ensure(plain);
}

}  // namespace probe::python

PYBIND11_MODULE(_vlaprobe, module) {
  using namespace probe::python;
  module.attr("__version__") = vlaprobe_version();
  module.attr("ACTION_SIZE") = VLAPROBE_ACTION_SIZE;
  module.attr("TOOL") = static_cast<int>(VLAPROBE_TOOL);
  module.attr("JOINT_STEPS") = static_cast<int>(VLAPROBE_JOINT_STEPS);
  module.attr("JOINT_POSITIONS") = static_cast<int>(VLAPROBE_JOINT_POSITIONS);
  if (vlaprobe_api_version() != VLAPROBE_API_VERSION)
    throw py::import_error("libvlaprobe.so is not the one that this module was built with");
  add_plan(module);
  add_stage(module);
  add_batch(module);
  add_run(module);
  add_ask(module);
}
