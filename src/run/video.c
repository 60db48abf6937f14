// SPDX-License-Identifier: MIT
#include "run/video.h"
#include "base/rate.h"

#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define ARGUMENTS_MAX      64
#define FORMAT_ARGUMENTS   24
#define PIPE_BYTES         (1 << 20) // holds a third of a 1280x720 frame; the default is 64 KiB
#define MESSAGE_TAIL_BYTES 600
#define FOLDER_FILENO      3 // descriptor of the video's folder in the ffmpeg process

struct Video {
    OutFile file;  // only ffmpeg writes to it; this stream is used to sync and rename
    pid_t process; // 0: none. Only video_destroy reaps it, so that video_kill never hits another
                   // process
    int input;     // write end of the pipe to ffmpeg's standard input; -1: closed
    int rest;      // our own read end of this pipe, never read: what ffmpeg leaves in it shows that
                   // it ended early; -1: closed
    int messages;  // ffmpeg's standard error: a file in memory, which nobody has to drain, unlike a
                   // pipe
    Leftover *group;
};

typedef struct Format {
    const char *suffix;
    bool has_alpha, is_even, halves_chroma;
    double fps_shown; // maximum frames per second; 0: no limit
    const char *filter, *filter_alpha;
    const char *arguments[FORMAT_ARGUMENTS];
} Format;

// Players assume BT.709 for videos of this size, but ffmpeg's default conversion from RGB is
// BT.601. The bitexact flag makes the conversion independent of the processor.
#define TO_YUV                                                                                     \
    "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+bitexact,format="

// Removes a last column that was added. Without `exact` the crop would keep whole pairs.
#define EXACT_CROP ",crop=iw-1:ih:0:0:exact=1"

static const double FPS_MAX = 1000;

static const Format formats[] = {
    {
        .suffix = ".mp4",
        .is_even = true, // H.264 with subsampled chroma needs even sizes
        .halves_chroma = true,
        .filter = TO_YUV "yuv420p",
        .arguments = {"-c:v", "libx264", "-preset", "fast", "-crf", "18", "-movflags", "+faststart",
                      "-f", "mp4"},
    },
    {
        .suffix = ".webm",
        .has_alpha = true,
        .halves_chroma = true,
        .filter = TO_YUV "yuv420p",
        .filter_alpha = TO_YUV "yuva420p",
        // Alternate reference frames cannot be transparent.
        .arguments = {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-cpu-used", "4",
                      "-tile-columns", "2", "-auto-alt-ref", "0", "-f", "webm"},
    },
    {
        .suffix = ".gif",
        .fps_shown = 50.0, // players slow down delays shorter than 20 ms
        // One palette for each frame: a common palette would need all frames in memory.
        .filter = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1",
        .arguments = {"-f", "gif"},
    },
};

static const Format *find_format(const char *path)
{
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        size_t suffix_length = strlen(formats[i].suffix);
        if (length > suffix_length &&
            strcasecmp(path + length - suffix_length, formats[i].suffix) == 0)
            return &formats[i];
    }
    return NULL;
}

Result video_check(const VideoOptions *options, Error *error)
{
    const Format *format = find_format(options->path);
    if (!format)
        return error_set(error, RESULT_USAGE,
                         "%s: expected a video's name, which ends in .mp4, .webm or .gif",
                         options->path);
    if (options->channels == 4 && !format->has_alpha)
        return error_set(
            error, RESULT_USAGE,
            "%s: %s cannot hold a transparent background: expected .webm or PNG frames",
            options->path, format->suffix);
    if (!(options->fps > 0.0 && options->fps <= FPS_MAX))
        return error_set(error, RESULT_USAGE, "%s: %g frames a second: expected at most %g",
                         options->path, options->fps, FPS_MAX);
    return RESULT_OK;
}

// The argument list of ffmpeg, and the texts that it points to.
typedef struct Command {
    char size[32], rate[32], filter[400];
    char *output;
    const char *arguments[ARGUMENTS_MAX];
    int count;
} Command;

static void add_arguments(Command *command, const char *const *arguments)
{
    for (; *arguments; arguments++) command->arguments[command->count++] = *arguments;
}

static void write_filter(Command *command, const Format *format, const VideoOptions *options)
{
    const char *filter = options->channels == 4 ? format->filter_alpha : format->filter;
    // ffmpeg makes the chroma of an odd last column from that column and bytes of the next row, so
    // the column is repeated first.
    int right = format->halves_chroma ? options->width % 2 : 0,
        bottom = format->is_even ? options->height % 2 : 0;
    if (right || bottom)
        snprintf(command->filter, sizeof command->filter,
                 "format=%s,pad=%d:%d,fillborders=right=%d:bottom=%d:mode=smear,%s%s",
                 options->channels == 4 ? "gbrap" : "gbrp", options->width + right,
                 options->height + bottom, right, bottom, filter,
                 format->is_even ? "" : EXACT_CROP);
    else if (format->fps_shown > 0 && options->fps > format->fps_shown)
        snprintf(command->filter, sizeof command->filter, "fps=%g,%s", format->fps_shown, filter);
    else
        snprintf(command->filter, sizeof command->filter, "%s", filter);
}

static bool make_command(Command *command, const Format *format, const VideoOptions *options,
                         const char *temporary)
{
    *command = (Command){0};
    snprintf(command->size, sizeof command->size, "%dx%d", options->width, options->height);
    long frames, seconds;
    rate_fraction(rate_snap(options->fps), &frames, &seconds);
    snprintf(command->rate, sizeof command->rate, "%ld/%ld", frames, seconds);
    write_filter(command, format, options);
    // Because the protocol is named, no character of the file's name has a meaning to ffmpeg. The
    // folder is given by the descriptor that ffmpeg inherits, so the file lands there even if the
    // folder's path has been renamed or replaced meanwhile.
    if (asprintf(&command->output, "file:/proc/self/fd/%d/%s", FOLDER_FILENO, temporary) < 0) {
        command->output = NULL;
        return false;
    }
    add_arguments(
        command, (const char *const[]){
                     "ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
                     // Without -xerror, ffmpeg exits with status 0 if the disk fills up at the end.
                     "-xerror", "-f", "rawvideo", "-pixel_format",
                     options->channels == 4 ? "rgba" : "rgb24", "-video_size", command->size,
                     "-framerate", command->rate, "-i", "pipe:0", "-lavfi", command->filter,
                     // The same frames must give the same bytes: no dates, no versions, and a fixed
                     // number of threads, because the encoders' results depend on it.
                     "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact",
                     "-threads", "4", NULL});
    if (format->filter_alpha || format->is_even)
        add_arguments(command,
                      (const char *const[]){"-colorspace", "bt709", "-color_primaries", "bt709",
                                            "-color_trc", "bt709", "-color_range", "tv", NULL});
    add_arguments(command, format->arguments);
    add_arguments(command, (const char *const[]){command->output, NULL});
    return true;
}

// Starts ffmpeg with an empty signal mask and default signal handlers, whatever this process has.
static int spawn(Video *video, const Command *command, int input_read_end)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, ignored;
    sigemptyset(&none);
    sigemptyset(&ignored);
    sigaddset(&ignored, SIGPIPE);
    sigaddset(&ignored, SIGXFSZ);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    int reason = posix_spawn_file_actions_adddup2(&actions, input_read_end, STDIN_FILENO);
    if (!reason)
        reason = posix_spawn_file_actions_adddup2(&actions, video->messages, STDERR_FILENO);
    if (!reason)
        reason =
            posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!reason)
        reason =
            posix_spawn_file_actions_adddup2(&actions, video->file.place.folder, FOLDER_FILENO);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &ignored);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK |
                                              POSIX_SPAWN_SETSIGDEF);
    // posix_spawnp does not write to the list; its declaration lacks the const for historical
    // reasons.
    if (!reason)
        reason = posix_spawnp(&video->process, "ffmpeg", &actions, &attributes,
                              (char *const *)command->arguments, environ);
    if (reason != 0) video->process = 0;
    if (reason == 0) video->group = leftover_add_group(video->process);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return reason;
}

static int start(Video *video, const Command *command)
{
    video->messages = memfd_create("ffmpeg-messages", MFD_CLOEXEC);
    int ends[2];
    if (video->messages < 0 || pipe2(ends, O_CLOEXEC) != 0) return errno;
    video->input = ends[1];
    // A request only: with a smaller pipe writing is slower, but works.
    fcntl(video->input, F_SETPIPE_SZ, PIPE_BYTES);
    // While this process holds a read end, a write to a full pipe would wait for ever for an ffmpeg
    // that has ended, so writes do not block.
    fcntl(video->input, F_SETFL, O_WRONLY | O_NONBLOCK);
    video->rest = ends[0];
    return spawn(video, command, ends[0]);
}

static Result start_ffmpeg(Video *video, const Format *format, const VideoOptions *options,
                           Error *error)
{
    // A device cannot be the target of a rename, and most formats are not written from front to
    // back.
    if (!video->file.temporary)
        return error_set(error, RESULT_FAILED, "%s: not a regular file", options->path);
    Command command;
    int reason = ENOMEM;
    if (make_command(&command, format, options, video->file.temporary))
        reason = start(video, &command);
    free(command.output);
    if (reason == ENOENT)
        return error_set(error, RESULT_FAILED,
                         "%s: ffmpeg is not installed: expected the Debian package ffmpeg, or PNG "
                         "frames as output",
                         options->path);
    if (reason != 0)
        return error_set(error, RESULT_FAILED, "%s: cannot start ffmpeg: %s", options->path,
                         strerror(reason));
    return RESULT_OK;
}

Result video_create(Video **video, const VideoOptions *options, Error *error)
{
    *video = NULL;
    const Format *format = find_format(options->path);
    TRY(video_check(options, error));
    Video *created = calloc(1, sizeof *created);
    if (!created) return error_set(error, RESULT_FAILED, "%s: no memory", options->path);
    created->input = created->messages = created->rest = -1;
    Result result = outfile_open(&created->file, options->path, error);
    THEN(result, start_ffmpeg(created, format, options, error));
    if (result == RESULT_OK)
        *video = created;
    else
        video_destroy(created);
    return result;
}

static void close_input(Video *video)
{
    if (video->input >= 0) close(video->input);
    video->input = -1;
}

// The last line that ffmpeg has written to standard error, "" if none.
static void read_last_message(const Video *video, char *text, size_t size)
{
    struct stat status;
    off_t start_at = 0;
    text[0] = 0;
    if (fstat(video->messages, &status) != 0) return;
    if (status.st_size >= (off_t)size) start_at = status.st_size - (off_t)size + 1;
    ssize_t length = pread(video->messages, text, size - 1, start_at);
    while (length > 0 && (text[length - 1] == '\n' || text[length - 1] == '\r')) length--;
    text[length > 0 ? length : 0] = 0;
    const char *line = strrchr(text, '\n');
    if (line) memmove(text, line + 1, strlen(line));
}

static bool has_ended(const Video *video)
{
    siginfo_t end = {0};
    return waitid(P_PID, (id_t)video->process, &end, WEXITED | WNOWAIT | WNOHANG) == 0 &&
           end.si_pid != 0;
}

// Waits until ffmpeg exits and returns its error. The process stays a zombie until video_destroy,
// so its process number is not reused.
static Result wait_end(Video *video, Error *error)
{
    close_input(video);
    siginfo_t end = {0};
    while (waitid(P_PID, (id_t)video->process, &end, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
    }
    int left = 0;
    if (video->rest >= 0) ioctl(video->rest, FIONREAD, &left);
    if (end.si_code == CLD_EXITED && end.si_status == 0 && left > 0)
        return error_set(error, RESULT_FAILED,
                         "%s: ffmpeg reported success but stopped reading: %d bytes of frames are "
                         "left",
                         video->file.path, left);
    if (end.si_code == CLD_EXITED && end.si_status == 0) return RESULT_OK;
    char message[MESSAGE_TAIL_BYTES];
    read_last_message(video, message, sizeof message);
    const char *colon = message[0] ? ": " : "";
    if (end.si_code == CLD_EXITED)
        return error_set(error, RESULT_FAILED, "%s: ffmpeg ended with status %d%s%s",
                         video->file.path, end.si_status, colon, message);
    return error_set(error, RESULT_FAILED, "%s: ffmpeg was ended by a signal (%s)%s%s",
                     video->file.path, strsignal(end.si_status), colon, message);
}

Result video_write(Video *video, const Image *image, Error *error)
{
    const uint8_t *data = image->pixels;
    size_t left = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    while (left > 0) {
        ssize_t written = write(video->input, data, left);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0 && errno == EAGAIN) {
            struct pollfd room = {.fd = video->input, .events = POLLOUT};
            if (poll(&room, 1, 200) != 0 || !has_ended(video)) continue;
            TRY(wait_end(video, error)); // names the reason, or what is left
            return error_set(error, RESULT_FAILED, "%s: ffmpeg stopped reading", video->file.path);
        }
        if (written < 0) {
            // ffmpeg's message says why the pipe broke.
            int reason = errno;
            bool broke = reason == EPIPE;
            if (broke && wait_end(video, error) != RESULT_OK) return RESULT_FAILED;
            return error_set(error, RESULT_FAILED, "%s: %s: %s", video->file.path,
                             broke ? "ffmpeg stopped reading" : "cannot write to ffmpeg",
                             strerror(reason));
        }
        data += written;
        left -= (size_t)written;
    }
    return RESULT_OK;
}

Result video_finish(Video *video, uint64_t *bytes, Error *error)
{
    *bytes = 0;
    TRY(wait_end(video, error));
    struct stat status;
    if (fstat(fileno(video->file.stream), &status) != 0)
        return error_set(error, RESULT_FAILED, "%s: %s", video->file.path, strerror(errno));
    *bytes = (uint64_t)status.st_size;
    if (*bytes == 0)
        return error_set(error, RESULT_FAILED,
                         "%s: ffmpeg reported success but wrote nothing: expected a video",
                         video->file.path);
    return outfile_commit(&video->file, error);
}

// Also kills ffmpeg's children, which hold the pipe open.
void video_kill(Video *video)
{
    kill(-video->process, SIGKILL);
}

void video_destroy(Video *video)
{
    if (!video) return;
    close_input(video);
    if (video->process > 0) {
        video_kill(video);
        leftover_forget(video->group);
        while (waitpid(video->process, NULL, 0) < 0 && errno == EINTR) {
        }
    }
    if (video->rest >= 0) close(video->rest);
    if (video->messages >= 0) close(video->messages);
    outfile_discard(&video->file);
    free(video);
}
