/* Direct3D's own shader tools as a command line: the assembler with its validator, the disassembler
 * and the HLSL compiler of a d3dcompiler_47.dll, run by Wine.  A witness for tests; nothing of the
 * product needs it.
 *
 *   judge asm FILE [-o OUT]                              assembles and validates text
 *   judge dis FILE                                       disassembles bytecode
 *   judge hlsl FILE ENTRY PROFILE [-o OUT] [-DNAME[=VALUE]]...   compiles HLSL, optimisation level
 * 3 judge batch LIST                                     one of the above per line of LIST, all in
 * one process
 *
 * What is accepted is printed as assembly text, and its bytecode written to OUT.  Exit code: 0
 * accepted, 1 refused (the reason, with its X number, on stderr), 3 wrong usage, unreadable file or
 * no DLL (named by JUDGE_DLL).  A batch prints everything to stdout, and after each command a line
 * "#### CODE"; its words cannot hold blanks. */
#define COBJMACROS
#include <d3dcompiler.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

enum Verdict { Accepted = 0, Refused = 1, Unusable = 3 };
enum { max_words = 64, max_defines = 32, max_line = 8192 };

/* In no header, though exported: text in, validated bytecode out. */
typedef HRESULT(WINAPI* AssembleFunction)(const void* text, SIZE_T size, const char* name,
                                          const D3D_SHADER_MACRO* defines, ID3DInclude* include,
                                          UINT flags, ID3DBlob** code, ID3DBlob** messages);

static struct {
    pD3DCompile compile;
    pD3DDisassemble disassemble;
    AssembleFunction assemble;
} tools;

typedef struct {
    const char *file, *entry, *profile, *output;
    D3D_SHADER_MACRO defines[max_defines + 1];
} Request;

typedef struct {
    char* bytes;
    size_t size;
} Content;

static int load_tools(void) {
    const char* path = getenv("JUDGE_DLL");
    HMODULE library = LoadLibraryA(path ? path : "d3dcompiler_47.dll");
    if (!library) return 0;
    tools.compile = (pD3DCompile)(void*)GetProcAddress(library, "D3DCompile");
    tools.disassemble = (pD3DDisassemble)(void*)GetProcAddress(library, "D3DDisassemble");
    tools.assemble = (AssembleFunction)(void*)GetProcAddress(library, "D3DAssemble");
    return tools.compile && tools.disassemble && tools.assemble;
}

static int load(const char* path, Content* content) {
    FILE* file = fopen(path, "rb");
    size_t room = 1 << 12;
    if (!file) return 0;
    content->bytes = malloc(room);
    content->size = 0;
    for (size_t got;
         (got = fread(content->bytes + content->size, 1, room - content->size, file)) > 0;) {
        content->size += got;
        if (content->size == room) content->bytes = realloc(content->bytes, room *= 2);
    }
    fclose(file);
    return 1;
}

static int save(const char* path, ID3DBlob* blob) {
    FILE* file = fopen(path, "wb");
    if (!file) return 0;
    const size_t size = ID3D10Blob_GetBufferSize(blob);
    const int whole = fwrite(ID3D10Blob_GetBufferPointer(blob), 1, size, file) == size;
    return !fclose(file) && whole;
}

/* Messages and disassembly end with a zero that is part of the blob. */
static void print_text(FILE* to, ID3DBlob* blob) {
    const char* text = ID3D10Blob_GetBufferPointer(blob);
    fprintf(to, "%.*s\n", (int)strnlen(text, ID3D10Blob_GetBufferSize(blob)), text);
    ID3D10Blob_Release(blob);
}

static enum Verdict print_disassembly(const void* bytes, size_t size, FILE* errors) {
    ID3DBlob* text = NULL;
    const HRESULT result = tools.disassemble(bytes, size, 0, NULL, &text);
    if (FAILED(result) || !text) {
        fprintf(errors, "not disassembled (0x%08lx)\n", (unsigned long)result);
        return Refused;
    }
    print_text(stdout, text);
    return Accepted;
}

/* Reports what a compiler or assembler answered, and lets go of it. */
static enum Verdict conclude(HRESULT result, ID3DBlob* code, ID3DBlob* messages,
                             const Request* request, FILE* errors) {
    enum Verdict verdict = Refused;
    if (messages) print_text(errors, messages);
    if (FAILED(result) || !code) {
        fprintf(errors, "refused (0x%08lx)\n", (unsigned long)result);
    } else if (request->output && !save(request->output, code)) {
        fprintf(errors, "cannot write %s\n", request->output);
        verdict = Unusable;
    } else {
        /* Some legal code cannot be printed; it is accepted all the same. */
        print_disassembly(ID3D10Blob_GetBufferPointer(code), ID3D10Blob_GetBufferSize(code),
                          errors);
        verdict = Accepted;
    }
    if (code) ID3D10Blob_Release(code);
    return verdict;
}

/* Fills the request from the words after the command's name; answers how many were neither option
 * nor surplus. */
static int read_request(int count, char** words, Request* request) {
    const char** operands[] = {&request->file, &request->entry, &request->profile};
    int operand_count = 0, define_count = 0;
    memset(request, 0, sizeof *request);
    for (int i = 0; i < count; i++) {
        if (!strncmp(words[i], "-D", 2)) {
            if (define_count == max_defines) return -1;
            char* value = strchr(words[i], '=');
            if (value) *value++ = 0;
            request->defines[define_count].Name = words[i] + 2;
            request->defines[define_count++].Definition = value ? value : "1";
        } else if (!strcmp(words[i], "-o")) {
            if (++i == count) return -1;
            request->output = words[i];
        } else {
            if (operand_count == 3) return -1;
            *operands[operand_count++] = words[i];
        }
    }
    return operand_count;
}

static enum Verdict obey(int count, char** words, FILE* errors) {
    Request request;
    Content content = {0};
    ID3DBlob *code = NULL, *messages = NULL;
    enum Verdict verdict = Unusable;
    const char* command = count ? words[0] : "";
    const int operands = read_request(count - 1, words + 1, &request);
    const int hlsl = !strcmp(command, "hlsl"), text = !strcmp(command, "asm"),
              code_in = !strcmp(command, "dis");
    if (!(hlsl && operands == 3) && !((text || code_in) && operands == 1)) {
        fprintf(errors,
                "usage: judge asm|dis FILE, judge hlsl FILE ENTRY PROFILE, judge batch LIST\n");
        return Unusable;
    }
    if (!load(request.file, &content)) {
        fprintf(errors, "cannot read %s\n", request.file);
        return Unusable;
    }
    if (code_in) {
        verdict = print_disassembly(content.bytes, content.size, errors);
    } else if (text) {
        const HRESULT result = tools.assemble(content.bytes, content.size, request.file,
                                              request.defines, NULL, 0, &code, &messages);
        verdict = conclude(result, code, messages, &request, errors);
    } else {
        const HRESULT result = tools.compile(content.bytes, content.size, request.file,
                                             request.defines, NULL, request.entry, request.profile,
                                             D3DCOMPILE_OPTIMIZATION_LEVEL3, 0, &code, &messages);
        verdict = conclude(result, code, messages, &request, errors);
    }
    free(content.bytes);
    return verdict;
}

static enum Verdict obey_list(const char* path) {
    static char line[max_line];
    FILE* list = fopen(path, "r");
    if (!list) {
        fprintf(stderr, "cannot read %s\n", path);
        return Unusable;
    }
    while (fgets(line, sizeof line, list)) {
        char* words[max_words];
        int count = 0;
        for (char* word = strtok(line, " \t\r\n"); word && count < max_words;
             word = strtok(NULL, " \t\r\n"))
            words[count++] = word;
        if (!count) continue;
        const enum Verdict verdict = obey(count, words, stdout);
        printf("\n#### %d\n", verdict);
        fflush(stdout);
    }
    fclose(list);
    return Accepted;
}

int main(int count, char** words) {
    if (!load_tools()) {
        fprintf(stderr, "cannot load d3dcompiler_47.dll; JUDGE_DLL names it\n");
        return Unusable;
    }
    if (count == 3 && !strcmp(words[1], "batch")) return obey_list(words[2]);
    return obey(count - 1, words + 1, stderr);
}
