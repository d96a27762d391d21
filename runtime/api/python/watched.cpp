#include "runtime/api/python/watched.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace probe::python {

void call_watched(Caller& caller, const std::function<std::int32_t(vlaprobe_error*)>& body) {
  Error error;
  std::int32_t code = VLAPROBE_OK;
  std::mutex mutex;
  std::condition_variable ended;
  bool is_over = false;
  std::optional<py::error_already_set> interrupt;
  {
    const py::gil_scoped_release release;
    std::thread worker([&] {
      code = body(error.get());
      const std::lock_guard lock(mutex);
      is_over = true;
      ended.notify_all();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return is_over; })) {
      lock.unlock();
      {
        const py::gil_scoped_acquire gil;
        if (!interrupt && PyErr_CheckSignals() != 0) {
          interrupt.emplace();
          caller.stop = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (interrupt) throw py::error_already_set(*interrupt);
  if (caller.raised) throw py::error_already_set(*caller.raised);
  if (code != VLAPROBE_OK) error.raise();
}

std::string taken(char* text) {
  std::string copy = text == nullptr ? "" : text;
  vlaprobe_free(text);
  return copy;
}

}  // namespace probe::python
