// SPDX-License-Identifier: Apache-2.0
// Ranks that are threads of one process: their messages lie in shared memory.
#pragma once

#include <barrier>
#include <thread>

#include "frontmost/streams.h"

namespace frontmost::test {

/// State that all ranks share.
struct MeetingPlace {
  explicit MeetingPlace(int count) : everyone(count), messages(std::size_t(count)) {}

  std::barrier<> everyone;
  std::vector<Ranks::Message> messages;
};

class ThreadRanks final : public Ranks {
 public:
  ThreadRanks(MeetingPlace& place, int number) : place_(place), number_(number) {}

  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] int count() const override { return int(place_.messages.size()); }
  void keep_greatest(std::span<std::uint64_t> values) override {
    std::vector<Message> all = everyone({reinterpret_cast<const std::byte*>(values.data()),
                                         reinterpret_cast<const std::byte*>(values.data() + values.size())});
    for (const Message& other : all) {
      ASSERT_EQ(other.size(), values.size_bytes());
      const auto* numbers = reinterpret_cast<const std::uint64_t*>(other.data());
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::max(values[i], numbers[i]);
    }
  }
  std::vector<Message> gather(Message message) override {
    std::vector<Message> all = everyone(std::move(message));
    return number_ == 0 ? all : std::vector<Message>();
  }
  Message broadcast(Message message) override { return everyone(std::move(message)).front(); }

 private:
  std::vector<Message> everyone(Message mine) {
    place_.messages[std::size_t(number_)] = std::move(mine);
    place_.everyone.arrive_and_wait();
    std::vector<Message> all = place_.messages;
    place_.everyone.arrive_and_wait();
    return all;
  }

  MeetingPlace& place_;
  int number_;
};

/// Calls act(ranks) on `count` ranks at once.
template <class Act>
void on_ranks(int count, const Act& act) {
  MeetingPlace place(count);
  std::vector<std::thread> threads;
  for (int number = 0; number < count; ++number)
    threads.emplace_back([&, number] {
      ThreadRanks ranks(place, number);
      act(ranks);
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace frontmost::test
