#include "experiments/run/run_store.h"

#include "experiments/files/atomic_file.h"
#include "experiments/files/state_file.h"
#include "experiments/records/record_json.h"

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCheckpoint = "checkpoint.state";
constexpr const char* kRecord = "record.state";

// Nothing where there is no such file, or where it belongs to another identity.
std::optional<StoredState> read_own(const fs::path& file, const std::string& identity,
                                    const RunStore::Complaint& complain) {
  if (!fs::exists(file)) return std::nullopt;
  try {
    StoredState stored = read_state(file);
    if (stored.about.value("identity", "") != identity) return std::nullopt;
    return stored;
  } catch (const Error& error) {
    complain(error);
    return std::nullopt;
  }
}

bool has_ended(const fs::path& manifest) {
  if (!fs::exists(manifest)) return false;
  try {
    const std::string status = read_json_file(manifest).value("status", "");
    return status == enum_name(RunStatus::finished) || status == enum_name(RunStatus::failed);
  } catch (const std::exception&) {
    return false;  // written by hand or by something else: the run is done again
  }
}

}  // namespace

void RunStore::write_checkpoint(FileQueue& files, const RunRecord& record, TracerState state) const {
  std::size_t bytes = 0;
  for (const SavedBuffer& buffer : state.buffers) bytes += buffer.bytes.size();
  StoredState stored{{{"identity", identity_}, {"record", pack(record)}}, std::move(state)};
  files.put(folder_ / kCheckpoint, bytes, [kept = std::move(stored)](const fs::path& temporary) {
    write_bytes(temporary, state_text(kept));
  });
}

std::optional<Checkpoint> RunStore::read_checkpoint(const Complaint& complain) const {
  auto stored = read_own(folder_ / kCheckpoint, identity_, complain);
  if (!stored) return std::nullopt;
  Checkpoint checkpoint;
  unpack(stored->about.at("record"), checkpoint.record);
  checkpoint.state = std::move(stored->state);
  return checkpoint;
}

void RunStore::remove_checkpoint(FileQueue& files) const {
  files.remove(folder_ / kCheckpoint);  // also one that still waits to be written
}

void RunStore::write_record(FileQueue& files, const RunRecord& record) const {
  files.put(folder_ / kRecord, state_text({{{"identity", identity_}, {"record", pack(record)}}, {}}));
}

std::optional<RunRecord> RunStore::read_record(const Run& run, const Complaint& complain) const {
  if (!has_ended(folder_ / "manifest.json")) return std::nullopt;
  const auto stored = read_own(folder_ / kRecord, identity_, complain);
  if (!stored) return std::nullopt;
  RunRecord record;
  unpack(stored->about.at("record"), record);
  record.run = run;
  return record;
}

}  // namespace qtrace::experiments
