// A verb that serves until it is told to end.
#pragma once

#include <signal.h>

namespace probe::cli {

// SIGINT and SIGTERM, held back from every thread that is made after this object.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&ends_);
    sigaddset(&ends_, SIGINT);
    sigaddset(&ends_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends_, nullptr);
  }
  void wait() const {
    int signal = 0;
    sigwait(&ends_, &signal);
  }

 private:
  sigset_t ends_{};
};

}  // namespace probe::cli
