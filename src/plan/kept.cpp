// Keys, and the folder: one small file for each trial, written whole, so that any number of plans
// can share it.
#include "src/plan/kept.h"

#include <elf.h>
#include <link.h>

#include <cstring>
#include <span>

#include <fmt/format.h>

#include "src/maps/files.h"
#include "src/measure/hash.h"
#include "src/plan/order.h"
#include "src/plan/trial_text.h"

namespace intaglio::plan {
namespace {

constexpr std::size_t largest_file = 1 << 16;

// The first object is the program itself; of its notes the one that the linker signs with.
int find_build_id(dl_phdr_info* object, std::size_t, void* into) {
    const std::size_t align = sizeof(ElfW(Word));
    const auto padded = [&](std::size_t size) { return (size + align - 1) / align * align; };
    for (int i = 0; i < object->dlpi_phnum; ++i) {
        const ElfW(Phdr)& header = object->dlpi_phdr[i];
        if (header.p_type != PT_NOTE) continue;
        const char* at = reinterpret_cast<const char*>(object->dlpi_addr + header.p_vaddr);
        const char* const end = at + header.p_memsz;
        while (at + sizeof(ElfW(Nhdr)) <= end) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof(note));
            const char* const name = at + sizeof(note);
            const char* const bytes = name + padded(note.n_namesz);
            if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
                std::memcmp(name, "GNU", 4) == 0) {
                std::string& id = *static_cast<std::string*>(into);
                for (std::size_t k = 0; k < note.n_descsz; ++k)
                    id += fmt::format("{:02x}", static_cast<unsigned char>(bytes[k]));
                return 1;
            }
            at = bytes + padded(note.n_descsz);
        }
    }
    return 1;
}

std::string text_of(const Rays& rays) {
    std::string text = fmt::format("{};", rays.size);
    for (const measure::Direction& view : rays.views)
        text += fmt::format("{} {};", view.elevation, view.azimuth);
    for (const Shot& shot : rays.shots)
        text += fmt::format("{} {} {} {} {};", shot.view.elevation, shot.view.azimuth, shot.light,
                            shot.towards.elevation, shot.towards.azimuth);
    return text;
}

}  // namespace

std::string program_id() {
    static const std::string id = [] {
        std::string found;
        dl_iterate_phdr(find_build_id, &found);
        return found;
    }();
    return id;
}

Kept::Kept(std::filesystem::path folder) : folder_(std::move(folder)), program_(program_id()) {
    if (program_.empty()) folder_.clear();
}

Result<Trial> Kept::run(const Site& site, const VariantRequest& request, const Rays& rays,
                        Ask ask) {
    measure::Hash hash;
    hash.add(fmt::format("{} {} {} {}\n", trial_schema, program_, static_cast<int>(ask),
                         site.identity()));
    hash.add(to_text(Order{"", request, {}, {}, {}}));
    hash.add(text_of(rays));
    const std::string key = hash.hex();
    return *trials_.get(key, [&]() -> Result<Trial> {
        const std::filesystem::path file =
            // What is only counted is counted again in less time than a file takes.
            folder_.empty() || ask == Ask::Size ? std::filesystem::path()
                                                : folder_ / key.substr(0, 2) / (key + ".json");
        if (!file.empty()) {
            const auto bytes = maps::read_file(file, largest_file);
            if (bytes) {
                const std::string_view text(reinterpret_cast<const char*>(bytes->data()),
                                            bytes->size());
                if (std::optional<Trial> trial = read_trial(text)) {
                    ++found_;
                    return std::move(*trial);
                }
            }
        }
        if (ask != Ask::Size) ++tried_;
        Result<Trial> trial = site.run(request, rays, ask);
        if (trial && !file.empty()) {
            // What cannot be kept is measured again: no reason to fail.
            std::error_code ignored;
            std::filesystem::create_directories(file.parent_path(), ignored);
            const std::string text = to_text(*trial);
            (void)maps::write_file(
                file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
        }
        return trial;
    });
}

}  // namespace intaglio::plan
