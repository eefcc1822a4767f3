// SPDX-License-Identifier: Apache-2.0
// Ranks by MPI's C interface, which counts in int, so longer messages are sent in parts.
#include <mpi.h>

#include <algorithm>

#include "cli/mpi/ranks_module.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t most_bytes = std::size_t(1) << 26;
/// Open MPI 4.1 merges 8 million numbers in parts of this size 10 times as fast as all at once.
constexpr std::size_t most_numbers = std::size_t(1) << 20;

/// Calls send(first, count) for parts of [0, size).
template <class Send>
void in_parts(std::size_t size, std::size_t most_at_once, const Send& send) {
  for (std::size_t first = 0; first < size; first += most_at_once)
    send(first, int(std::min(most_at_once, size - first)));
}

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &number_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] int count() const override { return count_; }

  void keep_greatest(std::span<std::uint64_t> values) override {
    in_parts(values.size(), most_numbers, [&](std::size_t first, int count) {
      MPI_Allreduce(MPI_IN_PLACE, values.data() + first, count, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    });
  }

  std::vector<Message> gather(Message message) override {
    const std::uint64_t size = message.size();
    std::vector<std::uint64_t> sizes(number_ == 0 ? std::size_t(count_) : 0);
    MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    if (number_ != 0) {
      in_parts(message.size(), most_bytes, [&](std::size_t first, int count) {
        MPI_Send(message.data() + first, count, MPI_BYTE, 0, 0, MPI_COMM_WORLD);
      });
      return {};
    }
    std::vector<Message> messages(sizes.size());
    messages[0] = std::move(message);
    for (int from = 1; from < count_; ++from) {
      messages[std::size_t(from)].resize(std::size_t(sizes[std::size_t(from)]));
      std::byte* const to = messages[std::size_t(from)].data();
      in_parts(messages[std::size_t(from)].size(), most_bytes, [&](std::size_t first, int count) {
        MPI_Recv(to + first, count, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
    }
    return messages;
  }

  Message broadcast(Message message) override {
    std::uint64_t size = message.size();
    MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    message.resize(std::size_t(size));
    in_parts(message.size(), most_bytes, [&](std::size_t first, int count) {
      MPI_Bcast(message.data() + first, count, MPI_BYTE, 0, MPI_COMM_WORLD);
    });
    return message;
  }

 private:
  int number_ = 0, count_ = 1;
};

}  // namespace
}  // namespace frontmost::cli

extern "C" __attribute__((visibility("default"))) frontmost::Ranks* frontmost_join_ranks() {
  return new frontmost::cli::MpiRanks;
}
