// What the cases of a sweep have in common, made once by whoever needs it first and shared by all
// threads: compiled variants, textures, exact hits, exact pictures.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "src/measure/compiled.h"
#include "src/measure/hits.h"

namespace intaglio::measure {

// Values by key, the `capacity` last used; whoever holds a value keeps it.
template <typename T>
class SharedCache {
  public:
    explicit SharedCache(std::size_t capacity) : capacity_(capacity) {}

    // The value under `key`; where there is none, make() is called, once, while others that want it
    // wait.
    template <typename Make>
    std::shared_ptr<const T> get(const std::string& key, const Make& make) {
        const std::shared_ptr<Entry> entry = entry_of(key);
        const std::lock_guard lock(entry->mutex);
        if (!entry->value) entry->value = std::make_shared<const T>(make());
        return entry->value;
    }

  private:
    struct Entry {
        std::mutex mutex;
        std::shared_ptr<const T> value;
        std::uint64_t used = 0;
    };

    std::shared_ptr<Entry> entry_of(const std::string& key) {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<Entry>& entry = entries_[key];
        if (!entry) entry = std::make_shared<Entry>();
        entry->used = ++clock_;
        const std::shared_ptr<Entry> wanted = entry;
        if (entries_.size() > capacity_) {
            auto oldest = entries_.begin();
            for (auto each = entries_.begin(); each != entries_.end(); ++each)
                if (each->second->used < oldest->second->used) oldest = each;
            entries_.erase(oldest);
        }
        return wanted;
    }

    std::size_t capacity_;
    std::mutex mutex_;
    std::uint64_t clock_ = 0;
    std::map<std::string, std::shared_ptr<Entry>> entries_;
};

struct Shared {
    SharedCache<Result<CompiledRow>> rows{256};
    SharedCache<Textures> textures{8};
    SharedCache<ExactPicture> exact{64};
    SharedCache<Result<check::Program>> shadings{64};
    SharedCache<Result<vulkan::Picture>> exact_pictures{64};
};

}  // namespace intaglio::measure
