// ldso::Error as the Python exception ldso.Error.

#include <exception>
#include <filesystem>
#include <regex>
#include <string>

#include "bindings/bindings.h"
#include "ldso/error.h"

namespace ldso::python {

namespace py = pybind11;

namespace {

/// The file and line that a context names, or None.
py::tuple file_and_line(const std::string& context) {
  static const std::regex kWithLine("^(.+):([0-9]+)$");
  std::smatch parts;
  if (std::regex_match(context, parts, kWithLine)) return py::make_tuple(parts[1].str(), std::stol(parts[2].str()));
  std::error_code error;
  const bool is_file = context.find('/') != context.npos || std::filesystem::exists(context, error);
  return py::make_tuple(is_file ? py::object(py::str(context)) : py::object(py::none()), py::none());
}

py::object to_python(const py::handle& type, const Error& error) {
  py::object made = type(error.what());
  const py::tuple where = file_and_line(error.context());
  made.attr("context") = error.context();
  made.attr("problem") = error.problem();
  made.attr("remedy") = error.remedy();
  made.attr("file") = where[0];
  made.attr("line") = where[1];
  return made;
}

}  // namespace

void bind_errors(py::module_& module) {
  static py::exception<Error> type(module, "Error", PyExc_RuntimeError);
  type.attr("__doc__") =
      "Bad input or bad use. str() says everything; its parts are `context` (where: a file, \"frame 7\", \"setting "
      "threads\"), `problem`, `remedy`, and `file` and `line` if it is about a file, else None.";
  for (const char* name : {"context", "problem", "remedy"}) type.attr(name) = "";
  for (const char* name : {"file", "line"}) type.attr(name) = py::none();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetObject(type.ptr(), to_python(type, error).ptr());
    }
  });
}

}  // namespace ldso::python
