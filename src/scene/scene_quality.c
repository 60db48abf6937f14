// SPDX-License-Identifier: MIT
#include "scene/scene_quality.h"

#include <assert.h>
#include <string.h>

static const struct {
    Quality quality;
    const char *name, *value;
} PRESETS[] = {
    {QUALITY_DRAFT, "lod_width", "1"},     {QUALITY_FINAL, "shadow", "dom"},
    {QUALITY_FINAL, "shadow_size", "512"}, {QUALITY_FINAL, "samples", "2"},
    {QUALITY_FINAL, "smooth", "3"},
};

Result quality_apply(Quality quality, ParamScope scope, void *params, Error *error)
{
    Result result = RESULT_OK;
    for (size_t i = 0; i < sizeof PRESETS / sizeof *PRESETS && result == RESULT_OK; ++i) {
        const ParamInfo *info = params_find(PRESETS[i].name);
        assert(info);
        if (PRESETS[i].quality == quality && info->scope == scope)
            result = params_parse(info, params, PRESETS[i].value, error);
    }
    return result;
}

Result quality_parse(Quality *quality, const char *word, Error *error)
{
    RunParams holder = {0};
    Result result = params_parse(params_find("quality"), &holder, word, error);
    *quality = (Quality)holder.quality;
    return result;
}
