// Files written by a thread of its own, so that rendering waits for no disk: in the order in which they were
// put, each whole or not at all.
#pragma once

#include "experiments/files/atomic_file.h"

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace qtrace::experiments {

// What is waiting is written together, flushed to the disk at once, and only then renamed, in order: a file
// that can be seen is whole, and so are all that were put before it, also after a power failure. (A flush
// takes some milliseconds, however much it holds; one per file would take longer than a small run.)
class FileQueue {
 public:
  using Write = std::function<void(const std::filesystem::path& temporary)>;

  // Who makes the files' content: the thread, beside the work; or, between its parts, whoever puts them,
  // where the work needs all cores and its time is measured. The thread always does what waits for the disk.
  enum class Content { by_thread, at_once };

  explicit FileQueue(Content content = Content::by_thread);
  ~FileQueue();  // waits until all is written
  FileQueue(const FileQueue&) = delete;
  FileQueue& operator=(const FileQueue&) = delete;

  // `bytes`: about what `write` holds in memory; above kMostBytes in all, this waits. Throws what went wrong
  // with an earlier file (DiskFull, Error): nothing is written after that until flush() has said so, too.
  void put(std::filesystem::path target, std::size_t bytes, Write write);
  void put(std::filesystem::path target, std::string content);
  // Removes a file, in its turn.
  void remove(std::filesystem::path target);

  // Waits until all is written. Throws what went wrong, after which the queue works again.
  void flush();

  static constexpr std::size_t kMostBytes = 512u << 20u;

 private:
  struct Job {
    std::filesystem::path target;
    std::size_t bytes = 0;
    Write write;                       // none: done, or the target is removed
    std::unique_ptr<AtomicFile> file;  // none: not yet written, or the target is removed
  };

  void push(Job job);
  void work();
  static void write_now(Job& job);
  static void carry_out(std::vector<Job>& batch);

  const Content content_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Job> waiting_;
  std::size_t bytes_ = 0;  // of waiting and of present jobs
  bool is_busy_ = false;
  bool is_ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace qtrace::experiments
