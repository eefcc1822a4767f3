// SPDX-License-Identifier: Apache-2.0
// What a row filter leaves of rendered pictures has runs, but few repeated strings: looking for those costs zlib and
// libdeflate most of their time. Here a byte is either taken as it is or repeats the one before it.
#include "io/images/png/run_deflater.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "io/images/png/prefix_code.h"

namespace frontmost::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "eight bytes are compared, and bits written, as one number");

/// What one code is made for. Depth maps become 2 to 4 % smaller by shorter blocks than a strip, and colours no larger.
constexpr std::size_t block_bytes = std::size_t(1) << 16;

// Tokens: 0 to 255 are bytes, run_token + n are n more of the byte before.
constexpr unsigned run_token = 256;
constexpr std::size_t shortest_run = 3, longest_run = 258;
constexpr std::size_t token_count = run_token + longest_run + 1;

// Symbols of the stream: bytes, the end of a block, and lengths of runs in 29 classes.
constexpr std::size_t end_of_block = 256, symbol_count = 286;
constexpr std::size_t first_of_class[] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                          31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::size_t class_count = std::size(first_of_class);

/// Bits behind the symbol of a class that tell which of its lengths is meant.
constexpr int extra_bits(std::size_t length_class) {
  return length_class < 8 || length_class == class_count - 1 ? 0 : int(length_class / 4) - 1;
}

/// How many bytes from `place` on equal the one before it, up to the longest run.
std::size_t run_at(const std::uint8_t* place, const std::uint8_t* end) {
  const std::uint8_t byte = place[-1];
  const std::uint64_t eight_times = byte * 0x0101010101010101u;
  const std::size_t most = std::min(longest_run, std::size_t(end - place));
  std::size_t length = 0;
  for (; length + 8 <= most; length += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, place + length, sizeof eight);
    if (eight != eight_times) return length + std::size_t(std::countr_zero(eight ^ eight_times)) / 8;
  }
  while (length < most && place[length] == byte) ++length;
  return length;
}

/// \returns the end of the tokens.
std::uint16_t* split_into_tokens(std::span<const std::uint8_t> raw, std::uint16_t* tokens) {
  const std::uint8_t *place = raw.data(), *const end = place + raw.size();
  *tokens++ = *place++;
  while (place < end) {
    const std::size_t run = *place == place[-1] ? run_at(place, end) : 0;
    *tokens++ = run >= shortest_run ? std::uint16_t(run_token + run) : *place;
    place += run >= shortest_run ? run : 1;
  }
  return tokens;
}

/// Puts bits into bytes, the lowest first.
class BitWriter {
 public:
  explicit BitWriter(std::uint8_t* out) : out_(out) {}

  /// At most 32 bits.
  void put(std::uint32_t bits, int count) {
    waiting_ |= std::uint64_t(bits) << count_;
    count_ += count;
    if (count_ < 32) return;
    std::memcpy(out_, &waiting_, 4);
    out_ += 4;
    waiting_ >>= 32;
    count_ -= 32;
  }
  /// Fills the last byte with zeros. \returns the end of the bytes.
  std::uint8_t* finish() {
    for (; count_ > 0; count_ -= 8, waiting_ >>= 8) *out_++ = std::uint8_t(waiting_);
    count_ = 0;
    return out_;
  }

 private:
  std::uint8_t* out_;
  std::uint64_t waiting_ = 0;
  int count_ = 0;
};

struct SymbolCode {
  std::array<std::uint8_t, symbol_count> lengths;
  std::array<std::uint16_t, symbol_count> codes;
};

SymbolCode code_of(std::span<const std::uint16_t> tokens) {
  // Two tables in turn: where one token follows itself, its count need not wait for the one just written.
  std::array<std::uint32_t, token_count> counts = {}, more = {};
  for (std::size_t i = 0; i + 1 < tokens.size(); i += 2) ++counts[tokens[i]], ++more[tokens[i + 1]];
  if (tokens.size() % 2 == 1) ++counts[tokens.back()];
  std::array<std::uint32_t, symbol_count> symbols = {};
  for (std::size_t byte = 0; byte < run_token; ++byte) symbols[byte] = counts[byte] + more[byte];
  symbols[end_of_block] = 1;
  std::size_t length_class = 0;
  for (std::size_t run = shortest_run; run <= longest_run; ++run) {
    if (length_class + 1 < class_count && run == first_of_class[length_class + 1]) ++length_class;
    symbols[end_of_block + 1 + length_class] += counts[run_token + run] + more[run_token + run];
  }
  SymbolCode code = {};
  find_code_lengths(symbols, 15, code.lengths);
  assign_codes(code.lengths, code.codes);
  return code;
}

/// One step of the list of code lengths: a length, or a symbol from 16 on that repeats one.
struct LengthStep {
  std::uint8_t symbol = 0;
  std::uint8_t extra = 0;
};
constexpr std::uint8_t repeat_last = 16, few_zeros = 17, many_zeros = 18;
constexpr std::size_t length_symbol_count = 19;

/// Deflate's shorthand for `lengths`.
std::vector<LengthStep> steps_of(std::span<const std::uint8_t> lengths) {
  std::vector<LengthStep> steps;
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t same = 1;
    while (i + same < lengths.size() && lengths[i + same] == lengths[i]) ++same;
    if (lengths[i] == 0 && same >= 3) {
      same = std::min<std::size_t>(same, 138);
      steps.push_back(same <= 10 ? LengthStep{few_zeros, std::uint8_t(same - 3)}
                                 : LengthStep{many_zeros, std::uint8_t(same - 11)});
    } else {
      steps.push_back({lengths[i], 0});
      same = std::min<std::size_t>(same, 7);
      if (same >= 4) {
        steps.push_back({repeat_last, std::uint8_t(same - 4)});
      } else {
        same = 1;
      }
    }
    i += same;
  }
  return steps;
}

/// The head of a block with codes of its own: their lengths, in a code of their own.
void put_head(const SymbolCode& code, bool last, BitWriter& bits) {
  constexpr std::size_t order[] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
  std::size_t symbols = symbol_count;
  while (code.lengths[symbols - 1] == 0) --symbols;
  std::vector<std::uint8_t> lengths(code.lengths.begin(), code.lengths.begin() + std::ptrdiff_t(symbols));
  lengths.push_back(1);  // of the one distance, 1: runs of one byte
  const std::vector<LengthStep> steps = steps_of(lengths);

  std::array<std::uint32_t, length_symbol_count> counts = {};
  for (const LengthStep& step : steps) ++counts[step.symbol];
  std::array<std::uint8_t, length_symbol_count> step_lengths;
  std::array<std::uint16_t, length_symbol_count> step_codes = {};
  find_code_lengths(counts, 7, step_lengths);
  assign_codes(step_lengths, step_codes);
  std::size_t listed = length_symbol_count;
  while (step_lengths[order[listed - 1]] == 0) --listed;

  bits.put(last ? 1 : 0, 1);
  bits.put(2, 2);  // codes of its own
  bits.put(std::uint32_t(symbols - 257), 5);
  bits.put(0, 5);  // one distance
  bits.put(std::uint32_t(listed - 4), 4);
  for (std::size_t i = 0; i < listed; ++i) bits.put(step_lengths[order[i]], 3);
  for (const LengthStep& step : steps) {
    bits.put(step_codes[step.symbol], step_lengths[step.symbol]);
    if (step.symbol == repeat_last) bits.put(step.extra, 2);
    if (step.symbol == few_zeros) bits.put(step.extra, 3);
    if (step.symbol == many_zeros) bits.put(step.extra, 7);
  }
}

/// What each token becomes: its symbol's code, the rest of its length and the bit of the distance in one.
struct TokenCode {
  std::uint32_t bits = 0;
  int count = 0;
};

std::array<TokenCode, token_count> token_codes(const SymbolCode& code) {
  std::array<TokenCode, token_count> tokens;
  for (std::size_t byte = 0; byte < run_token; ++byte) tokens[byte] = {code.codes[byte], code.lengths[byte]};
  for (std::size_t i = 0; i < class_count; ++i) {
    const std::size_t symbol = end_of_block + 1 + i, first = first_of_class[i];
    const std::size_t end = i + 1 < class_count ? first_of_class[i + 1] : longest_run + 1;
    const int length = code.lengths[symbol];
    for (std::size_t run = first; run < end; ++run)
      tokens[run_token + run] = {code.codes[symbol] | std::uint32_t(run - first) << length, length + extra_bits(i) + 1};
  }
  return tokens;
}

void put_block(std::span<const std::uint16_t> tokens, bool last, BitWriter& bits) {
  const SymbolCode code = code_of(tokens);
  put_head(code, last, bits);
  const std::array<TokenCode, token_count> codes = token_codes(code);
  for (const std::uint16_t token : tokens) bits.put(codes[token].bits, codes[token].count);
  bits.put(code.codes[end_of_block], code.lengths[end_of_block]);
}

}  // namespace

// A byte has at most 15 bits, a run of three fewer than 24; the codes of a block are listed in less than a kilobyte.
RunDeflater::RunDeflater(std::size_t most_bytes)
    : tokens_(std::min(most_bytes, block_bytes)), out_(2 * most_bytes + 1024 * (most_bytes / block_bytes + 1)) {}

std::span<const std::uint8_t> RunDeflater::compress(std::span<const std::uint8_t> raw, bool last) {
  BitWriter bits(out_.data());
  for (; !raw.empty(); raw = raw.subspan(std::min(raw.size(), block_bytes))) {
    const std::span block = raw.first(std::min(raw.size(), block_bytes));
    const std::span<const std::uint16_t> tokens(tokens_.data(), split_into_tokens(block, tokens_.data()));
    put_block(tokens, last && block.size() == raw.size(), bits);
  }
  if (last) return {out_.data(), bits.finish()};
  constexpr std::uint8_t no_bytes[] = {0x00, 0x00, 0xFF, 0xFF};  // the length of an empty block, and its complement
  bits.put(0, 3);  // its head, without compression: what follows begins on a byte
  return {out_.data(), std::copy(std::begin(no_bytes), std::end(no_bytes), bits.finish())};
}

}  // namespace frontmost::detail
