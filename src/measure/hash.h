// 128 bits that tell contents apart: XXH3 of libxxhash.  Not a secret's hash.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace intaglio::measure {

class Hash {
  public:
    Hash();
    ~Hash();
    void add(std::string_view bytes);
    // Of all that was added: 32 hexadecimal digits.
    std::string hex() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace intaglio::measure
