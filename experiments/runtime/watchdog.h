// Notices that something takes too long, from a thread of its own: a driver that hangs never returns.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace qtrace::experiments {

class Watchdog {
 public:
  Watchdog();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // From now on, until disarm(), more than `seconds` are too long: `late` is then called once on the
  // watchdog's thread, and disarm() waits for it. It is noticed up to kPause later.
  void arm(double seconds, std::function<void()> late);
  void disarm();

  static constexpr std::chrono::milliseconds kPause{50};

 private:
  using Clock = std::chrono::steady_clock;
  void watch();

  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_ended_ = false;
  std::optional<Clock::time_point> deadline_;
  std::function<void()> late_;
  std::thread thread_;
};

// Armed as long as it lives, however that ends. Without a watchdog, nothing.
class WatchedTime {
 public:
  WatchedTime(Watchdog* watchdog, double seconds, std::function<void()> late) : watchdog_(watchdog) {
    if (watchdog_ != nullptr) watchdog_->arm(seconds, std::move(late));
  }
  ~WatchedTime() {
    if (watchdog_ != nullptr) watchdog_->disarm();
  }
  WatchedTime(const WatchedTime&) = delete;
  WatchedTime& operator=(const WatchedTime&) = delete;

 private:
  Watchdog* watchdog_;
};

}  // namespace qtrace::experiments
