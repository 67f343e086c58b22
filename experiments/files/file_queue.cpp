#include "experiments/files/file_queue.h"

#include <set>
#include <utility>

namespace qtrace::experiments {

FileQueue::FileQueue(Content content) : content_(content), thread_([this] { work(); }) {}

FileQueue::~FileQueue() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FileQueue::put(std::filesystem::path target, std::size_t bytes, Write write) {
  push({std::move(target), bytes, std::move(write), nullptr});
}

void FileQueue::put(std::filesystem::path target, std::string content) {
  const std::size_t bytes = content.size();
  push({std::move(target), bytes,
        [text = std::move(content)](const std::filesystem::path& temporary) { write_bytes(temporary, text); },
        nullptr});
}

void FileQueue::remove(std::filesystem::path target) { push({std::move(target), 0, {}, nullptr}); }

void FileQueue::push(Job job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failure_ || bytes_ < kMostBytes; });
  if (failure_) std::rethrow_exception(failure_);
  if (content_ == Content::at_once && job.write) {
    lock.unlock();
    write_now(job);
    job.bytes = 0;
    lock.lock();
  }
  bytes_ += job.bytes;
  waiting_.push_back(std::move(job));
  lock.unlock();
  changed_.notify_all();
}

void FileQueue::flush() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !is_busy_; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void FileQueue::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_ended_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::vector<Job> batch = std::exchange(waiting_, {});
    is_busy_ = true;
    std::exception_ptr failure = failure_;  // what follows a lost file is not written: it may rely on it
    lock.unlock();
    try {
      if (!failure) carry_out(batch);
    } catch (...) {
      failure = std::current_exception();
    }
    std::size_t done = 0;
    for (const Job& job : batch) done += job.bytes;
    batch.clear();
    lock.lock();
    bytes_ -= done;
    failure_ = failure;
    is_busy_ = false;
    changed_.notify_all();
  }
}

void FileQueue::write_now(Job& job) {
  job.file = std::make_unique<AtomicFile>(job.target);
  try {
    job.write(job.file->temporary());
  } catch (const DiskFull&) {
    throw;
  } catch (const std::exception& error) {
    fail_to_write(job.target, error.what());
  }
  job.write = nullptr;  // and what it holds
}

// What a later job of the batch would replace is not written at all.
void FileQueue::carry_out(std::vector<Job>& batch) {
  std::set<std::filesystem::path> later;
  for (std::size_t i = batch.size(); i-- > 0;) {
    if (!later.insert(batch[i].target).second) batch.erase(batch.begin() + static_cast<std::ptrdiff_t>(i));
  }
  std::vector<std::filesystem::path> written;
  for (Job& job : batch) {
    if (job.write) write_now(job);
    if (job.file) written.push_back(job.file->temporary());
  }
  flush_to_disk(written);
  for (const Job& job : batch) {
    if (job.file) {
      job.file->rename();
    } else {
      std::error_code ignored;
      std::filesystem::remove(job.target, ignored);
    }
  }
}

}  // namespace qtrace::experiments
