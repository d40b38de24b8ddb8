// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The library's exceptions as Python's, with their one-line messages.
#include "parts.hpp"
#include "trussmap/error.hpp"
#include "trussmap/table.hpp"

#include <filesystem>

namespace trussmap::python {
namespace {

namespace py = pybind11;

/// As the command says it.
std::string message_of(const std::exception& error) {
  return shortened_words(escaped_controls(error.what(), true));
}

py::handle input_error;
py::handle solve_error;

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    py::object value = input_error(message_of(error));
    value.attr("file") = error.file();
    value.attr("line") = error.line();
    PyErr_SetObject(input_error.ptr(), value.ptr());
  } catch (const SolveError& error) {
    PyErr_SetString(solve_error.ptr(), message_of(error).c_str());
  } catch (const std::invalid_argument& error) {
    PyErr_SetString(PyExc_ValueError, message_of(error).c_str());
  } catch (const std::filesystem::filesystem_error& error) {
    PyErr_SetString(PyExc_OSError, message_of(error).c_str());
  }
}

}  // namespace

void add_errors(py::module_& module) {
  // Kept for the translator as long as the interpreter lives: modules are never unloaded.
  input_error = py::exception<InputError>(module, "InputError", PyExc_ValueError).release();
  solve_error = py::exception<SolveError>(module, "SolveError", PyExc_RuntimeError).release();
  input_error.attr("__doc__") =
      "What was given is wrong: a file, its `line` (0: as a whole), what was found and expected.";
  input_error.attr("file") = "";
  input_error.attr("line") = 0;
  solve_error.attr("__doc__") =
      "What was given is well formed, but the problem has no answer; the message says why.";
  py::register_exception_translator(translate);
}

}  // namespace trussmap::python
