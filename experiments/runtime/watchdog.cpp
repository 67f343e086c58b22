#include "experiments/runtime/watchdog.h"

#include <utility>

namespace qtrace::experiments {

Watchdog::Watchdog() : thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

// Nothing is notified: a frame can be shorter than waking a thread, which looks by itself now and then.
void Watchdog::arm(double seconds, std::function<void()> late) {
  const std::lock_guard lock(mutex_);
  deadline_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  late_ = std::move(late);
}

void Watchdog::disarm() {
  const std::lock_guard lock(mutex_);
  deadline_.reset();
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  while (!is_ended_) {
    if (deadline_ && Clock::now() > *deadline_) {
      deadline_.reset();
      late_();
    }
    ended_.wait_for(lock, kPause);
  }
}

}  // namespace qtrace::experiments
