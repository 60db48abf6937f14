// SPDX-License-Identifier: MIT
#include "image/png.h"
#include "image/image_kind.h"
#include "image/png_color.h"

#include "image/png_rows.h"

#include <endian.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { PALETTE_COLORS = 256 };
enum { ENCODE_MAX_BYTES = 1 << 30, READ_MAX_PIXELS = 1 << 28, READ_MAX_SIDE = 1 << 20 };
// Limits of memory: a factor on the file's size, plus a constant.
enum { READ_MAX_FACTOR = 64, READ_SURE_BYTES = 64 << 20 };
enum { TEXT_MAX_BYTES = 1 << 17, TEXT_MAX_COUNT = 128 };
enum { BYTE_BITS = 8, SIGNATURE_BYTES = 8 };

// The state shared with libpng's callbacks. libpng reports errors by longjmp, so a step must keep
// everything that needs cleaning up in here.
typedef struct Codec {
    png_structp png;
    png_infop info;
    char reason[200];     // of the failure
    const uint8_t *bytes; // file being read
    size_t size, at;
    Bytes written; // file being written, with `room` bytes allocated
    size_t room;
    const Image *source;      // image to be written
    Bytes rows;               // of the source, compressed
    const png_color *palette; // `colors` entries, if the source has indices; NULL otherwise
    int colors;
    const ImageTexts *texts;
    png_text *chunks; // texts in libpng's form
    Image image;      // being read
    bool deep;        // keep 16 bits per sample
    bool memory_is_short;
} Codec;

static void fail(png_structp png, png_const_charp message)
{
    Codec *codec = png_get_error_ptr(png);
    // Keep the warning that came before: it says which part of the header is wrong.
    if (!codec->reason[0] || strncmp(message, "Invalid IHDR", 12) != 0)
        snprintf(codec->reason, sizeof codec->reason, "%s", message);
    png_longjmp(png, 1);
}

static void warn(png_structp png, png_const_charp message)
{
    Codec *codec = png_get_error_ptr(png);
    snprintf(codec->reason, sizeof codec->reason, "%s", message);
}

// Runs the step. If it fails, returns false and `reason` has the message.
static bool go(Codec *codec, void (*step)(Codec *codec))
{
    if (setjmp(png_jmpbuf(codec->png))) return false;
    step(codec);
    return true;
}

// --- Writing.

static void take_bytes(png_structp png, png_bytep bytes, size_t size)
{
    Codec *codec = png_get_io_ptr(png);
    Bytes *out = &codec->written;
    if (size > codec->room - out->size) png_error(png, "chunks of an unexpected size");
    memcpy(out->data + out->size, bytes, size);
    out->size += size;
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

static bool is_ascii(const char *text)
{
    while (*text && !(*text & 0x80)) ++text;
    return !*text;
}

static void write_file(Codec *codec)
{
    const Image *image = codec->source;
    png_set_write_fn(codec->png, codec, take_bytes, flush_nothing);
    png_set_IHDR(codec->png, codec->info, (png_uint_32)image->width, (png_uint_32)image->height,
                 image->kind == IMAGE_16 ? 16 : 8,
                 codec->palette         ? PNG_COLOR_TYPE_PALETTE
                 : image->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA
                                        : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (codec->palette) png_set_PLTE(codec->png, codec->info, codec->palette, codec->colors);
    size_t count = codec->texts ? codec->texts->count : 0;
    for (size_t i = 0; i < count; ++i) {
        const ImageText *text = &codec->texts->list[i];
        codec->chunks[i] =
            (png_text){.compression = is_ascii(text->value) ? PNG_TEXT_COMPRESSION_NONE
                                                            : PNG_ITXT_COMPRESSION_NONE,
                       .key = (png_charp)text->key,
                       .text = text->value};
    }
    png_set_text(codec->png, codec->info, codec->chunks, (int)count);
    png_write_info(codec->png, codec->info);
    png_write_chunk(codec->png, (png_const_bytep) "IDAT", codec->rows.data, codec->rows.size);
    png_write_chunk(codec->png, (png_const_bytep) "IEND", NULL, 0);
}

// Room for the file: a chunk takes 12 bytes besides its data; text chunks take a few more.
static bool make_room(Codec *codec)
{
    enum { REST = 256 + 3 * PALETTE_COLORS };
    size_t count = codec->texts ? codec->texts->count : 0;
    codec->room = codec->rows.size + REST;
    for (size_t i = 0; i < count; ++i)
        codec->room += strlen(codec->texts->list[i].value) + IMAGE_TEXT_KEY_BYTES + REST;
    codec->chunks = calloc(count + 1, sizeof *codec->chunks);
    codec->written.data = malloc(codec->room + 1);
    codec->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, codec, fail, warn);
    codec->info = codec->png ? png_create_info_struct(codec->png) : NULL;
    return codec->chunks && codec->written.data && codec->info;
}

static Result encode(Codec *codec, Bytes *png, Error *error)
{
    const Image *image = codec->source;
    Result result = RESULT_OK;
    *png = (Bytes){0};
    if (image_size(image) + (size_t)image->height >= ENCODE_MAX_BYTES)
        return error_set(
            error, RESULT_FAILED,
            "an image of %d x %d pixels is too large: expected less than 1 GiB of pixels",
            image->width, image->height);
    if (!(codec->palette ? png_rows_pack_indices : png_rows_pack)(image, &codec->rows) ||
        !make_room(codec))
        result = error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d",
                           image->width, image->height);
    else if (!go(codec, write_file))
        result = error_set(error, RESULT_FAILED, "cannot encode an image of %d x %d: %s",
                           image->width, image->height, codec->reason);
    if (result == RESULT_OK) {
        *png = codec->written;
        png->data[png->size] = 0;
    } else {
        bytes_destroy(&codec->written);
    }
    png_destroy_write_struct(&codec->png, &codec->info);
    free(codec->chunks);
    bytes_destroy(&codec->rows);
    return result;
}

Result png_encode(const Image *image, const ImageTexts *texts, Bytes *png, Error *error)
{
    Codec codec = {.source = image, .texts = texts};
    return encode(&codec, png, error);
}

// Finds the index of each pixel's colour; false if there are more than PALETTE_COLORS colours.
// Neighbours are often equal, so the last index is tried first.
static bool find_palette(const Image *image, uint8_t *indices, png_color palette[PALETTE_COLORS],
                         int *colors)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    int last = 0;
    *colors = 0;
    for (size_t i = 0; i < count; ++i) {
        const uint8_t *rgb = image->pixels + 3 * i;
        if (!*colors || memcmp(&palette[last], rgb, 3) != 0)
            for (last = 0; last < *colors && memcmp(&palette[last], rgb, 3) != 0;) ++last;
        if (last == PALETTE_COLORS) return false;
        if (last == *colors) palette[(*colors)++] = (png_color){rgb[0], rgb[1], rgb[2]};
        indices[i] = (uint8_t)last;
    }
    return true;
}

Result png_encode_palette(const Image *image, Bytes *png, Error *error)
{
    png_color palette[PALETTE_COLORS];
    Image indices = {.width = image->width, .height = image->height, .channels = 1};
    Codec codec = {.source = &indices, .palette = palette};
    indices.pixels = malloc((size_t)image->width * (size_t)image->height);
    bool fits = indices.pixels && image->channels == 3 && image->kind == IMAGE_8 &&
                find_palette(image, indices.pixels, palette, &codec.colors);
    Result result = fits ? encode(&codec, png, error) : png_encode(image, NULL, png, error);
    free(indices.pixels);
    return result;
}

Result png_write(const char *path, const Image *image, Error *error)
{
    Bytes png;
    Result result = png_encode(image, NULL, &png, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", path);
    result = bytes_write_file(&png, path, error);
    bytes_destroy(&png);
    return result;
}

// --- Reading.

static void give_bytes(png_structp png, png_bytep bytes, size_t size)
{
    Codec *codec = png_get_io_ptr(png);
    if (size > codec->size - codec->at) png_error(png, "it ends too early");
    memcpy(bytes, codec->bytes + codec->at, size);
    codec->at += size;
}

// Reads only the pixels and the chunks that they need, and treats any error in these as fatal.
static void expect_pixels(Codec *codec)
{
    png_set_keep_unknown_chunks(codec->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_benign_errors(codec->png, 0);
    png_set_crc_action(codec->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
}

static void expect_texts(Codec *codec)
{
    static const png_byte names[] = "tEXt\0zTXt\0iTXt";
    expect_pixels(codec);
    png_set_keep_unknown_chunks(codec->png, PNG_HANDLE_CHUNK_AS_DEFAULT, names, 3);
    png_set_benign_errors(codec->png, 1);
    png_set_crc_action(codec->png, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
}

static void read_header(Codec *codec)
{
    png_structp png = codec->png;
    png_set_read_fn(png, codec, give_bytes);
    png_set_user_limits(png, READ_MAX_SIDE, READ_MAX_SIDE);
    png_set_chunk_malloc_max(png, TEXT_MAX_BYTES);
    png_set_chunk_cache_max(png, TEXT_MAX_COUNT);
    png_read_info(png, codec->info);
    png_set_expand(png); // palettes, grey below 8 bits, transparent colours
    png_set_gray_to_rgb(png);
    if (!codec->deep)
        png_set_strip_16(png);
    else if (htobe16(1) != 1)
        png_set_swap(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, codec->info);
    codec->image = (Image){.width = (int)png_get_image_width(png, codec->info),
                           .height = (int)png_get_image_height(png, codec->info),
                           .channels = png_get_channels(png, codec->info),
                           .kind = png_get_bit_depth(png, codec->info) == 16 ? IMAGE_16 : IMAGE_8};
}

static void read_pixels(Codec *codec)
{
    png_structp png = codec->png;
    size_t row = png_get_rowbytes(png, codec->info);
    int passes = png_get_interlace_type(png, codec->info) == PNG_INTERLACE_NONE
                     ? 1
                     : PNG_INTERLACE_ADAM7_PASSES;
    for (int pass = 0; pass < passes; ++pass)
        for (int y = 0; y < codec->image.height; ++y)
            png_read_row(png, codec->image.pixels + (size_t)y * row, NULL);
    png_read_end(png, NULL);
}

// The pixels are not cleared: a header may promise a large image, and untouched pages cost no
// memory.
static Result make_image(Codec *codec, const char *path, Error *error)
{
    Image *image = &codec->image;
    long long count = (long long)image->width * image->height;
    if (count > READ_MAX_PIXELS)
        return error_set(error, RESULT_BAD_INPUT, "%s: %d x %d pixels: expected at most %d pixels",
                         path, image->width, image->height, READ_MAX_PIXELS);
    size_t size = image_size(image), most = READ_MAX_FACTOR * codec->size + READ_SURE_BYTES;
    if (size > most)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %d x %d pixels in a file of %zu bytes: expected pixels of at most %d "
                         "times the file's size plus %d MiB",
                         path, image->width, image->height, codec->size, READ_MAX_FACTOR,
                         READ_SURE_BYTES >> 20);
    image->pixels = malloc(size);
    if (image->pixels) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: no memory for %d x %d pixels", path, image->width,
                     image->height);
}

// libpng trusts the length that a chunk declares. This limit makes it refuse lengths out of
// proportion to the file's size. If memory is short, libpng leaves out a text and goes on.
static png_voidp give_memory(png_structp png, size_t size)
{
    Codec *codec = png_get_mem_ptr(png);
    if (size > READ_MAX_FACTOR * codec->size + READ_SURE_BYTES) return NULL;
    void *block = malloc(size);
    if (!block) codec->memory_is_short = true;
    return block;
}

static void take_memory(png_structp png, png_voidp block)
{
    (void)png;
    free(block);
}

static Result fail_memory(const char *path, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s: no memory to read it", path);
}

static Result refuse_kind(const Bytes *file, const char *path, Error *error)
{
    const char *kind = image_kind_name(file);
    if (kind)
        return error_set(error, RESULT_BAD_INPUT, "%s: %s, not a PNG file: convert it to PNG", path,
                         kind);
    return error_set(error, RESULT_BAD_INPUT, "%s: not a PNG file", path);
}

static Result open_reader(Codec *codec, const Bytes *file, const char *path, Error *error)
{
    *codec = (Codec){.bytes = file->data, .size = file->size};
    size_t start = file->size < SIGNATURE_BYTES ? file->size : SIGNATURE_BYTES;
    if (start == 0 || png_sig_cmp(file->data, 0, start) != 0) return refuse_kind(file, path, error);
    codec->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, codec, fail, warn, codec,
                                          give_memory, take_memory);
    codec->info = codec->png ? png_create_info_struct(codec->png) : NULL;
    return codec->info ? RESULT_OK : fail_memory(path, error);
}

// Runs the step; an error names the file.
static Result try_step(Codec *codec, void (*step)(Codec *codec), const char *path, Error *error)
{
    bool good = go(codec, step);
    if (codec->memory_is_short) return fail_memory(path, error);
    if (good) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: not a readable PNG file: %s", path,
                     codec->reason);
}

static Result decode(Image *image, bool deep, const Bytes *file, const char *path, Error *error)
{
    Codec codec;
    *image = (Image){0};
    Result result = open_reader(&codec, file, path, error);
    codec.deep = deep;
    THEN(result, try_step(&codec, expect_pixels, path, error));
    THEN(result, try_step(&codec, read_header, path, error));
    THEN(result, make_image(&codec, path, error));
    THEN(result, try_step(&codec, read_pixels, path, error));
    THEN(result, png_color_convert(&codec.image, file, path, error));
    if (result == RESULT_OK)
        *image = codec.image;
    else
        image_destroy(&codec.image);
    png_destroy_read_struct(&codec.png, &codec.info, NULL);
    return result;
}

Result png_decode_deep(Image *image, const Bytes *file, const char *path, Error *error)
{
    return decode(image, true, file, path, error);
}

Result png_read(Image *image, const char *path, Error *error)
{
    *image = (Image){0};
    Bytes file;
    TRY(bytes_read_file(&file, path, error));
    Result result = decode(image, false, &file, path, error);
    bytes_destroy(&file);
    return result;
}

// --- Texts.

// A Latin-1 character takes at most two bytes in UTF-8.
static Result set_latin(ImageTexts *texts, const char *key, const char *latin, Error *error)
{
    char *text = malloc(2 * strlen(latin) + 1), *to = text;
    if (!text) return error_set(error, RESULT_FAILED, "no memory for the texts of an image");
    for (const uint8_t *at = (const uint8_t *)latin; *at; ++at) {
        if (*at >= 0x80) *to++ = (char)(0xc0 | *at >> 6);
        *to++ = (char)(*at < 0x80 ? *at : 0x80 | (*at & 0x3f));
    }
    *to = 0;
    Result result = image_texts_set(texts, key, text, error);
    free(text);
    return result;
}

static Result take_texts(ImageTexts *texts, const Codec *codec, Error *error)
{
    png_textp found;
    int count = png_get_text(codec->png, codec->info, &found, NULL);
    for (int i = 0; i < count; ++i) {
        if (!image_texts_is_key(found[i].key) || !found[i].text) continue;
        bool latin = found[i].compression < PNG_ITXT_COMPRESSION_NONE;
        TRY(latin ? set_latin(texts, found[i].key, found[i].text, error)
                  : image_texts_set(texts, found[i].key, found[i].text, error));
    }
    return RESULT_OK;
}

Result png_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error)
{
    Codec codec;
    *texts = (ImageTexts){0};
    Result result = open_reader(&codec, file, path, error);
    THEN(result, try_step(&codec, expect_texts, path, error));
    THEN(result, try_step(&codec, read_header, path, error));
    THEN(result, take_texts(texts, &codec, error));
    if (result != RESULT_OK) image_texts_destroy(texts);
    png_destroy_read_struct(&codec.png, &codec.info, NULL);
    return result;
}
