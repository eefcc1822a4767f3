// SPDX-License-Identifier: Apache-2.0
// Memory for large planes. The first touch of a 4 KiB page costs about as much as writing it several times. With large
// pages, 32 MiB are ready in 5 ms instead of 15.

#include "base/memory.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <span>

#include "base/parallel.h"
#include "frontmost/base.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace frontmost {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kLargePage = std::size_t(2) << 20;
constexpr std::size_t kWorthLargePages = kLargePage;
/// glibc keeps a freed block for the next call only if the block has less than 32 MiB.
constexpr std::size_t kMostArena = std::size_t(28) << 20;

constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// The whole small pages of a range.
[[maybe_unused]] std::span<char> pages_of(void* start, std::size_t bytes) {
  constexpr std::size_t small_page = 4096;
  const auto first = reinterpret_cast<std::uintptr_t>(start);
  const std::uintptr_t begin = round_up(first, small_page);
  return {static_cast<char*>(start) + (begin - first), (first + bytes) / small_page * small_page - begin};
}

}  // namespace

void want_large_pages(void* start, std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (bytes < kWorthLargePages) return;
  const std::span<char> pages = pages_of(start, bytes);
  // If small pages are larger than the range, the system refuses.
  (void)madvise(pages.data(), pages.size(), MADV_HUGEPAGE);
#else
  (void)start, (void)bytes;
#endif
}

void populate_pages(void* start, std::size_t bytes, const Execution& execution) {
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
  if (bytes < kWorthLargePages) return;
  const std::span<char> pages = pages_of(start, bytes);
  parallel_for(execution, pages.size(), kLargePage, [&](std::size_t begin, std::size_t end) {
    (void)madvise(pages.data() + begin, end - begin, MADV_POPULATE_WRITE);
  });
#else
  (void)start, (void)bytes, (void)execution;
#endif
}

namespace detail {

/// Header before the contents of a Buffer.
struct alignas(kAlignment) Block {
  Slab* slab = nullptr;     ///< null: the block has memory of its own
  Block* before = nullptr;  ///< the previous block of the slab
  bool is_dropped = false;
};
static_assert(sizeof(Block) + kAlignment <= Arena::beside);  // the header, and contents rounded up

/// The header of a slab; a stack of blocks follows it in memory.
struct alignas(kAlignment) Slab {
  Slab(void* whole, std::size_t room) : memory(whole), next(reinterpret_cast<char*>(this + 1)), end(next + room) {}

  [[nodiscard]] Block* take(std::size_t bytes) {
    const std::lock_guard lock(mutex);
    if (bytes > std::size_t(end - next)) return nullptr;
    last = new (next) Block{this, last};
    next += bytes;
    ++users;
    return last;
  }
  /// Drops `block`, or the arena if `block` is null. \returns whether nothing uses the slab any more.
  [[nodiscard]] bool drop(Block* block) noexcept {
    const std::lock_guard lock(mutex);
    if (block) block->is_dropped = true;
    for (; last && last->is_dropped; last = last->before) next = reinterpret_cast<char*>(last);
    return --users == 0;
  }

  void* const memory;  ///< the allocation that holds the slab

 private:
  std::mutex mutex;
  char *next, *end;
  Block* last = nullptr;
  std::size_t users = 1;  ///< number of users: the arena and the blocks
};

namespace {

/// The slab of this thread's innermost Arena. A template, so that builds without arenas have no thread-local variable.
template <bool has_room>
struct CurrentSlab {
  static Slab*& place() {
    static thread_local Slab* slab = nullptr;
    return slab;
  }
  static Slab* get() { return place(); }
  static void set(Slab* slab) { place() = slab; }
};
template <>
struct CurrentSlab<false> {
  static Slab* get() { return nullptr; }
  static void set(Slab*) {}
};
using Current = CurrentSlab<Arena::has_room>;

/// Allocates large blocks in large pages; null if there is no memory.
void* allocate_alone(std::size_t bytes) {
  const bool large = bytes >= kWorthLargePages;
  const std::size_t alignment = large ? kLargePage : kAlignment;
  void* pointer = std::aligned_alloc(alignment, round_up(bytes, alignment));
  // Small pages are better for a last large page that would be less than half full.
  if (pointer && large) want_large_pages(pointer, (bytes + kLargePage / 2) / kLargePage * kLargePage);
  return pointer;
}

void drop(Slab* slab, Block* block) noexcept {
  if (!slab->drop(block)) return;
  void* const memory = slab->memory;
  slab->~Slab();
  std::free(memory);
}

/// Uses malloc() instead of aligned_alloc(). glibc serves a request from kept memory only up to the size of the last
/// freed block, not counting its padding for alignment. The next aligned request, whose padding counts, would be too
/// large.
Slab* make_slab(std::size_t room) {
  const std::size_t size = sizeof(Slab) + room, alignment = size < kWorthLargePages ? kAlignment : kLargePage;
  void* const memory = std::malloc(size + alignment);
  if (!memory) return nullptr;
  void* start = memory;
  std::size_t space = size + alignment;
  std::align(alignment, size, start, space);
  want_large_pages(start, size / kLargePage * kLargePage);
  return new (start) Slab(memory, room);
}

}  // namespace

void* allocate(std::size_t bytes) {
  // Sizes near the greatest would wrap around to a small size when rounded up.
  if (bytes > std::size_t(-1) - 2 * kLargePage) throw std::bad_alloc();
  const std::size_t size = sizeof(Block) + round_up(bytes, kAlignment);
  Slab* const current = Current::get();
  if (Block* block = current ? current->take(size) : nullptr) return block + 1;
  void* pointer = allocate_alone(size);
  if (!pointer) throw std::bad_alloc();
  auto* block = new (pointer) Block;
  return block + 1;
}

void release(void* pointer) noexcept {
  if (!pointer) return;
  Block* block = static_cast<Block*>(pointer) - 1;
  if (block->slab)
    drop(block->slab, block);
  else
    std::free(block);
}

}  // namespace detail

Arena::Arena(std::size_t bytes) : outer_(detail::Current::get()) {
  slab_ = has_room ? detail::make_slab(round_up(std::min(bytes, kMostArena), kAlignment)) : nullptr;
  if (slab_) detail::Current::set(slab_);
}

Arena::~Arena() {
  detail::Current::set(outer_);
  if (slab_) detail::drop(slab_, nullptr);
}

}  // namespace frontmost
