/* What post_plugin.h has besides, and nobody reads from top to bottom: what words of a control mean, for `vocabulary` of
 * PostDialect, and assertions that the compiler lays out the structs as the host does. post_plugin.h includes it.
 */
#ifndef POST_PLUGIN_TABLES_H
#define POST_PLUGIN_TABLES_H

#include "post_plugin.h"

#ifdef __cplusplus
#define POST_ASSERT static_assert
#define POST_ALIGN alignof
#else
#define POST_ASSERT _Static_assert
#define POST_ALIGN _Alignof
#endif

/* generated: begin */
#define POST_MEANING_REMARK 1u
#define POST_MEANING_REMARK_OPEN 2u
#define POST_MEANING_REMARK_CLOSE 3u
#define POST_MEANING_BLOCK_NUMBER 4u
#define POST_MEANING_NOTHING 5u
#define POST_MEANING_MILLIMETRE 10u
#define POST_MEANING_INCH 11u
#define POST_MEANING_ABSOLUTE 12u
#define POST_MEANING_INCREMENTAL 13u
#define POST_MEANING_PLANE_XY 14u
#define POST_MEANING_PLANE_ZX 15u
#define POST_MEANING_PLANE_YZ 16u
#define POST_MEANING_RAPID 20u
#define POST_MEANING_LINEAR 21u
#define POST_MEANING_ARC_CLOCKWISE 22u
#define POST_MEANING_ARC_COUNTER_CLOCKWISE 23u
#define POST_MEANING_CENTRE_X 24u
#define POST_MEANING_CENTRE_Y 25u
#define POST_MEANING_CENTRE_Z 26u
#define POST_MEANING_RADIUS 27u
#define POST_MEANING_SPLINE 28u
#define POST_MEANING_MACHINE_COORDINATES 29u
#define POST_MEANING_FEED 30u
#define POST_MEANING_FEED_PER_MINUTE 31u
#define POST_MEANING_INVERSE_TIME 32u
#define POST_MEANING_FEED_PER_REVOLUTION 33u
#define POST_MEANING_RAPID_BLOCK 34u
#define POST_MEANING_LENGTH_ON 40u
#define POST_MEANING_LENGTH_OFF 41u
#define POST_MEANING_LENGTH_REGISTER 42u
#define POST_MEANING_COMPENSATION_OFF 43u
#define POST_MEANING_COMPENSATION_LEFT 44u
#define POST_MEANING_COMPENSATION_RIGHT 45u
#define POST_MEANING_RADIUS_REGISTER 46u
#define POST_MEANING_TCP_ON 47u
#define POST_MEANING_TCP_OFF 48u
#define POST_MEANING_TILTED_PLANE 50u
#define POST_MEANING_TILTED_PLANE_TURN 51u
#define POST_MEANING_TILTED_PLANE_OFF 52u
#define POST_MEANING_WORK_OFFSET 53u
#define POST_MEANING_SMOOTHING 54u
#define POST_MEANING_SMOOTHING_OFF 55u
#define POST_MEANING_TOOL 60u
#define POST_MEANING_TOOL_CHANGE 61u
#define POST_MEANING_SPINDLE_SPEED 62u
#define POST_MEANING_SPINDLE_CLOCKWISE 63u
#define POST_MEANING_SPINDLE_COUNTER_CLOCKWISE 64u
#define POST_MEANING_SPINDLE_OFF 65u
#define POST_MEANING_SPINDLE_ORIENT 66u
#define POST_MEANING_COOLANT_ON 67u
#define POST_MEANING_COOLANT_OFF 68u
#define POST_MEANING_DWELL 70u
#define POST_MEANING_STOP 71u
#define POST_MEANING_OPTIONAL_STOP 72u
#define POST_MEANING_END 73u
#define POST_MEANING_SUBPROGRAM 74u
#define POST_MEANING_PROBE 75u
#define POST_MEANING_CYCLE_DRILL 80u
#define POST_MEANING_CYCLE_DEEP 81u
#define POST_MEANING_CYCLE_BREAK_CHIP 82u
#define POST_MEANING_CYCLE_TAP 83u
#define POST_MEANING_CYCLE_TAP_LEFT 84u
#define POST_MEANING_CYCLE_REAM 85u
#define POST_MEANING_CYCLE_BORE 86u
#define POST_MEANING_CYCLE_BORE_FINE 87u
#define POST_MEANING_CYCLE_BORE_BACK 88u
#define POST_MEANING_CYCLE_OFF 89u
#define POST_MEANING_RETURN_START 90u
#define POST_MEANING_CYCLE_OFF_SPINDLE_OFF 218u
#define POST_MEANING_RETURN_CLEARANCE 91u
#define POST_MEANING_REFERENCE_RETURN 100u
#define POST_MEANING_OTHER_REFERENCE_RETURN 101u
#define POST_MEANING_RETRACT 102u
#define POST_MEANING_BUILDER_COORDINATES 103u
#define POST_MEANING_EXACT_STOP 104u
#define POST_MEANING_THREAD 105u
#define POST_MEANING_THREAD_AND_BACK 106u
#define POST_MEANING_THREAD_BACK 107u
#define POST_MEANING_LOCAL_OFFSET 110u
#define POST_MEANING_LOCAL_OFFSET_ADDED 111u
#define POST_MEANING_LOCAL_OFFSET_OFF 112u
#define POST_MEANING_SET_POSITION 113u
#define POST_MEANING_SET_POSITION_OFF 114u
#define POST_MEANING_SET_POSITION_AGAIN 115u
#define POST_MEANING_WORK_OFFSET_OFF 116u
#define POST_MEANING_WORK_OFFSET_BLOCK 117u
#define POST_MEANING_TABLE_DATA 118u
#define POST_MEANING_TABLE_DATA_OFF 119u
#define POST_MEANING_ROTATION 120u
#define POST_MEANING_ROTATION_ADDED 121u
#define POST_MEANING_ROTATION_OFF 122u
#define POST_MEANING_SCALE 123u
#define POST_MEANING_SCALE_OFF 124u
#define POST_MEANING_MIRROR 125u
#define POST_MEANING_MIRROR_OFF 126u
#define POST_MEANING_POLAR 130u
#define POST_MEANING_POLAR_OFF 131u
#define POST_MEANING_FACE_TRANSFORMATION 132u
#define POST_MEANING_FACE_TRANSFORMATION_OFF 133u
#define POST_MEANING_CYLINDER_TRANSFORMATION 134u
#define POST_MEANING_CENTRE_ABSOLUTE 135u
#define POST_MEANING_CENTRE_INCREMENTAL 136u
#define POST_MEANING_DIAMETER 137u
#define POST_MEANING_DIAMETER_OFF 138u
#define POST_MEANING_ROTARY_SHORTEST 139u
#define POST_MEANING_ROTARY_AS_WRITTEN 140u
#define POST_MEANING_TCP_VECTOR_ON 141u
#define POST_MEANING_LENGTH_ALONG_TOOL 142u
#define POST_MEANING_LENGTH_STATED 143u
#define POST_MEANING_LENGTH_ADDED 144u
#define POST_MEANING_LENGTH_NEGATIVE 145u
#define POST_MEANING_TOOL_AXIS_X 146u
#define POST_MEANING_TOOL_AXIS_Y 147u
#define POST_MEANING_TOOL_AXIS_Z 148u
#define POST_MEANING_NORMAL_X 149u
#define POST_MEANING_NORMAL_Y 150u
#define POST_MEANING_NORMAL_Z 151u
#define POST_MEANING_ORIENTATION_PART 152u
#define POST_MEANING_ORIENTATION_MACHINE 153u
#define POST_MEANING_ORIENTATION_AXES 154u
#define POST_MEANING_ORIENTATION_VECTOR 155u
#define POST_MEANING_ORIENTATION_ANGLES 156u
#define POST_MEANING_PRESELECT 160u
#define POST_MEANING_SPINDLE_CLOCKWISE_COOLANT 161u
#define POST_MEANING_SPINDLE_COUNTER_CLOCKWISE_COOLANT 162u
#define POST_MEANING_SURFACE_SPEED 163u
#define POST_MEANING_SURFACE_SPEED_OFF 164u
#define POST_MEANING_SPEED_LIMIT 165u
#define POST_MEANING_CLAMP 166u
#define POST_MEANING_UNCLAMP 167u
#define POST_MEANING_SURFACE_SPEED_PER_REVOLUTION 203u
#define POST_MEANING_SURFACE_SPEED_PER_MINUTE 204u
#define POST_MEANING_FIXED_SPEED_PER_REVOLUTION 205u
#define POST_MEANING_FIXED_SPEED_PER_MINUTE 206u
#define POST_MEANING_TOOL_AND_OFFSET 207u
#define POST_MEANING_NOT_FOLLOWED 208u
#define POST_MEANING_SUBPROGRAM_END 170u
#define POST_MEANING_LOCAL_SUBPROGRAM 171u
#define POST_MEANING_MACRO 172u
#define POST_MEANING_MACRO_MODAL 173u
#define POST_MEANING_MACRO_OFF 174u
#define POST_MEANING_CYCLE_CALL 175u
#define POST_MEANING_CYCLE_CALL_MODAL 176u
#define POST_MEANING_CYCLE_OTHER 177u
#define POST_MEANING_RETURN_LEVEL 178u
#define POST_MEANING_DWELL_SECONDS 180u
#define POST_MEANING_DWELL_MILLISECONDS 181u
#define POST_MEANING_DWELL_TURNS 182u
#define POST_MEANING_ARC_THROUGH 183u
#define POST_MEANING_ARC_TANGENT 184u
#define POST_MEANING_TURNS 185u
#define POST_MEANING_ARC_ANGLE 186u
#define POST_MEANING_ROTARY_FEED_LENGTH 187u
#define POST_MEANING_ROTARY_FEED_ANGLE 188u
#define POST_MEANING_INCH_LENGTHS 189u
#define POST_MEANING_MILLIMETRE_LENGTHS 190u
#define POST_MEANING_CENTRE 191u
#define POST_MEANING_ARC 192u
#define POST_MEANING_FEED_PER_MINUTE_ALL_AXES 193u
#define POST_MEANING_MACHINE_COORDINATES_ON 194u
#define POST_MEANING_MACHINE_COORDINATES_OFF 195u
#define POST_MEANING_JOINT_MOVE 200u
#define POST_MEANING_POSE_MOVE 201u
#define POST_MEANING_JOINTS_NOW 202u
#define POST_MEANING_STRAIGHT_MOVE 209u
#define POST_MEANING_DIAMETER_OF_POSITIONS 210u
#define POST_MEANING_TOOL_FRAME 211u
#define POST_MEANING_OWN_TOOL_FRAME 212u
#define POST_MEANING_TOOL_AND_FRAME 213u
#define POST_MEANING_OWN_AXIS_WORDS 214u
#define POST_MEANING_NO_AXIS_WORDS 215u
#define POST_MEANING_EXTRUDER_POSITIONS 216u
#define POST_MEANING_ANY_CONFIGURATION 217u
POST_ASSERT(sizeof(PostText) == 16 && POST_ALIGN(PostText) == 8, "PostText");
POST_ASSERT(offsetof(PostText, ptr) == 0, "PostText.ptr");
POST_ASSERT(offsetof(PostText, len) == 8, "PostText.len");
POST_ASSERT(sizeof(PostSink) == 16 && POST_ALIGN(PostSink) == 8, "PostSink");
POST_ASSERT(offsetof(PostSink, ctx) == 0, "PostSink.ctx");
POST_ASSERT(offsetof(PostSink, write) == 8, "PostSink.write");
POST_ASSERT(sizeof(PostValue) == 40 && POST_ALIGN(PostValue) == 8, "PostValue");
POST_ASSERT(offsetof(PostValue, kind) == 0, "PostValue.kind");
POST_ASSERT(offsetof(PostValue, reserved) == 4, "PostValue.reserved");
POST_ASSERT(offsetof(PostValue, integer) == 8, "PostValue.integer");
POST_ASSERT(offsetof(PostValue, number) == 16, "PostValue.number");
POST_ASSERT(offsetof(PostValue, text) == 24, "PostValue.text");
POST_ASSERT(sizeof(PostPair) == 56 && POST_ALIGN(PostPair) == 8, "PostPair");
POST_ASSERT(offsetof(PostPair, key) == 0, "PostPair.key");
POST_ASSERT(offsetof(PostPair, value) == 16, "PostPair.value");
POST_ASSERT(sizeof(PostOption) == 112 && POST_ALIGN(PostOption) == 8, "PostOption");
POST_ASSERT(offsetof(PostOption, key) == 0, "PostOption.key");
POST_ASSERT(offsetof(PostOption, help) == 16, "PostOption.help");
POST_ASSERT(offsetof(PostOption, kind) == 32, "PostOption.kind");
POST_ASSERT(offsetof(PostOption, reserved) == 36, "PostOption.reserved");
POST_ASSERT(offsetof(PostOption, min) == 40, "PostOption.min");
POST_ASSERT(offsetof(PostOption, max) == 48, "PostOption.max");
POST_ASSERT(offsetof(PostOption, default_value) == 56, "PostOption.default_value");
POST_ASSERT(offsetof(PostOption, choices) == 96, "PostOption.choices");
POST_ASSERT(offsetof(PostOption, choices_len) == 104, "PostOption.choices_len");
POST_ASSERT(sizeof(PostAxisWord) == 48 && POST_ALIGN(PostAxisWord) == 8, "PostAxisWord");
POST_ASSERT(offsetof(PostAxisWord, name) == 0, "PostAxisWord.name");
POST_ASSERT(offsetof(PostAxisWord, rotary) == 16, "PostAxisWord.rotary");
POST_ASSERT(offsetof(PostAxisWord, depth) == 20, "PostAxisWord.depth");
POST_ASSERT(offsetof(PostAxisWord, carries_part) == 24, "PostAxisWord.carries_part");
POST_ASSERT(offsetof(PostAxisWord, reserved) == 28, "PostAxisWord.reserved");
POST_ASSERT(offsetof(PostAxisWord, least) == 32, "PostAxisWord.least");
POST_ASSERT(offsetof(PostAxisWord, largest) == 40, "PostAxisWord.largest");
POST_ASSERT(sizeof(PostTool) == 48 && POST_ALIGN(PostTool) == 8, "PostTool");
POST_ASSERT(offsetof(PostTool, name) == 0, "PostTool.name");
POST_ASSERT(offsetof(PostTool, number) == 16, "PostTool.number");
POST_ASSERT(offsetof(PostTool, reserved) == 20, "PostTool.reserved");
POST_ASSERT(offsetof(PostTool, length) == 24, "PostTool.length");
POST_ASSERT(offsetof(PostTool, diameter) == 32, "PostTool.diameter");
POST_ASSERT(offsetof(PostTool, corner_radius) == 40, "PostTool.corner_radius");
POST_ASSERT(sizeof(PostEvent) == 40 && POST_ALIGN(PostEvent) == 8, "PostEvent");
POST_ASSERT(offsetof(PostEvent, kind) == 0, "PostEvent.kind");
POST_ASSERT(offsetof(PostEvent, texts_len) == 4, "PostEvent.texts_len");
POST_ASSERT(offsetof(PostEvent, line) == 8, "PostEvent.line");
POST_ASSERT(offsetof(PostEvent, numbers) == 16, "PostEvent.numbers");
POST_ASSERT(offsetof(PostEvent, numbers_len) == 24, "PostEvent.numbers_len");
POST_ASSERT(offsetof(PostEvent, texts) == 32, "PostEvent.texts");
POST_ASSERT(sizeof(PostDeviation) == 48 && POST_ALIGN(PostDeviation) == 8, "PostDeviation");
POST_ASSERT(offsetof(PostDeviation, tip) == 0, "PostDeviation.tip");
POST_ASSERT(offsetof(PostDeviation, axis) == 24, "PostDeviation.axis");
POST_ASSERT(sizeof(PostTolerance) == 16 && POST_ALIGN(PostTolerance) == 8, "PostTolerance");
POST_ASSERT(offsetof(PostTolerance, tip) == 0, "PostTolerance.tip");
POST_ASSERT(offsetof(PostTolerance, axis) == 8, "PostTolerance.axis");
POST_ASSERT(sizeof(PostCurve) == 512 && POST_ALIGN(PostCurve) == 8, "PostCurve");
POST_ASSERT(offsetof(PostCurve, tip_peak) == 0, "PostCurve.tip_peak");
POST_ASSERT(offsetof(PostCurve, tip_at) == 8, "PostCurve.tip_at");
POST_ASSERT(offsetof(PostCurve, axis_peak) == 16, "PostCurve.axis_peak");
POST_ASSERT(offsetof(PostCurve, axis_at) == 24, "PostCurve.axis_at");
POST_ASSERT(offsetof(PostCurve, terms) == 32, "PostCurve.terms");
POST_ASSERT(sizeof(PostSetup) == 208 && POST_ALIGN(PostSetup) == 8, "PostSetup");
POST_ASSERT(offsetof(PostSetup, size) == 0, "PostSetup.size");
POST_ASSERT(offsetof(PostSetup, program) == 8, "PostSetup.program");
POST_ASSERT(offsetof(PostSetup, machine) == 24, "PostSetup.machine");
POST_ASSERT(offsetof(PostSetup, units) == 40, "PostSetup.units");
POST_ASSERT(offsetof(PostSetup, tcp) == 44, "PostSetup.tcp");
POST_ASSERT(offsetof(PostSetup, words) == 48, "PostSetup.words");
POST_ASSERT(offsetof(PostSetup, words_len) == 56, "PostSetup.words_len");
POST_ASSERT(offsetof(PostSetup, options) == 64, "PostSetup.options");
POST_ASSERT(offsetof(PostSetup, options_len) == 72, "PostSetup.options_len");
POST_ASSERT(offsetof(PostSetup, cl_file) == 80, "PostSetup.cl_file");
POST_ASSERT(offsetof(PostSetup, tip_tolerance) == 96, "PostSetup.tip_tolerance");
POST_ASSERT(offsetof(PostSetup, axis_tolerance) == 104, "PostSetup.axis_tolerance");
POST_ASSERT(offsetof(PostSetup, rapid_tolerance) == 112, "PostSetup.rapid_tolerance");
POST_ASSERT(offsetof(PostSetup, ahead) == 120, "PostSetup.ahead");
POST_ASSERT(offsetof(PostSetup, moves) == 124, "PostSetup.moves");
POST_ASSERT(offsetof(PostSetup, tools) == 128, "PostSetup.tools");
POST_ASSERT(offsetof(PostSetup, tools_len) == 136, "PostSetup.tools_len");
POST_ASSERT(offsetof(PostSetup, least) == 144, "PostSetup.least");
POST_ASSERT(offsetof(PostSetup, largest) == 168, "PostSetup.largest");
POST_ASSERT(offsetof(PostSetup, time) == 192, "PostSetup.time");
POST_ASSERT(offsetof(PostSetup, turns_part) == 200, "PostSetup.turns_part");
POST_ASSERT(offsetof(PostSetup, diameters) == 204, "PostSetup.diameters");
POST_ASSERT(sizeof(PostFormat) == 112 && POST_ALIGN(PostFormat) == 8, "PostFormat");
POST_ASSERT(offsetof(PostFormat, size) == 0, "PostFormat.size");
POST_ASSERT(offsetof(PostFormat, words) == 8, "PostFormat.words");
POST_ASSERT(offsetof(PostFormat, feed) == 40, "PostFormat.feed");
POST_ASSERT(offsetof(PostFormat, inverse_time) == 44, "PostFormat.inverse_time");
POST_ASSERT(offsetof(PostFormat, feed_per_revolution) == 48, "PostFormat.feed_per_revolution");
POST_ASSERT(offsetof(PostFormat, words_len) == 52, "PostFormat.words_len");
POST_ASSERT(offsetof(PostFormat, extension) == 56, "PostFormat.extension");
POST_ASSERT(offsetof(PostFormat, writes) == 72, "PostFormat.writes");
POST_ASSERT(offsetof(PostFormat, most_inverse_time) == 80, "PostFormat.most_inverse_time");
POST_ASSERT(offsetof(PostFormat, plane_angles) == 88, "PostFormat.plane_angles");
POST_ASSERT(offsetof(PostFormat, plane_decimals) == 92, "PostFormat.plane_decimals");
POST_ASSERT(offsetof(PostFormat, language) == 96, "PostFormat.language");
POST_ASSERT(offsetof(PostFormat, reserved) == 100, "PostFormat.reserved");
POST_ASSERT(offsetof(PostFormat, rapid_feed) == 104, "PostFormat.rapid_feed");
POST_ASSERT(sizeof(PostPlugin) == 112 && POST_ALIGN(PostPlugin) == 8, "PostPlugin");
POST_ASSERT(offsetof(PostPlugin, magic) == 0, "PostPlugin.magic");
POST_ASSERT(offsetof(PostPlugin, abi) == 8, "PostPlugin.abi");
POST_ASSERT(offsetof(PostPlugin, kind) == 12, "PostPlugin.kind");
POST_ASSERT(offsetof(PostPlugin, size) == 16, "PostPlugin.size");
POST_ASSERT(offsetof(PostPlugin, table_size) == 20, "PostPlugin.table_size");
POST_ASSERT(offsetof(PostPlugin, layout) == 24, "PostPlugin.layout");
POST_ASSERT(offsetof(PostPlugin, name) == 32, "PostPlugin.name");
POST_ASSERT(offsetof(PostPlugin, version) == 48, "PostPlugin.version");
POST_ASSERT(offsetof(PostPlugin, describe) == 64, "PostPlugin.describe");
POST_ASSERT(offsetof(PostPlugin, loaded) == 72, "PostPlugin.loaded");
POST_ASSERT(offsetof(PostPlugin, dialect) == 80, "PostPlugin.dialect");
POST_ASSERT(offsetof(PostPlugin, model) == 88, "PostPlugin.model");
POST_ASSERT(offsetof(PostPlugin, about) == 96, "PostPlugin.about");
POST_ASSERT(sizeof(PostDialect) == 56 && POST_ALIGN(PostDialect) == 8, "PostDialect");
POST_ASSERT(offsetof(PostDialect, open) == 0, "PostDialect.open");
POST_ASSERT(offsetof(PostDialect, format) == 8, "PostDialect.format");
POST_ASSERT(offsetof(PostDialect, write) == 16, "PostDialect.write");
POST_ASSERT(offsetof(PostDialect, last_error) == 24, "PostDialect.last_error");
POST_ASSERT(offsetof(PostDialect, close) == 32, "PostDialect.close");
POST_ASSERT(offsetof(PostDialect, vocabulary) == 40, "PostDialect.vocabulary");
POST_ASSERT(offsetof(PostDialect, relies_on) == 48, "PostDialect.relies_on");
POST_ASSERT(sizeof(PostModel) == 40 && POST_ALIGN(PostModel) == 8, "PostModel");
POST_ASSERT(offsetof(PostModel, open) == 0, "PostModel.open");
POST_ASSERT(offsetof(PostModel, fit) == 8, "PostModel.fit");
POST_ASSERT(offsetof(PostModel, value) == 16, "PostModel.value");
POST_ASSERT(offsetof(PostModel, last_error) == 24, "PostModel.last_error");
POST_ASSERT(offsetof(PostModel, close) == 32, "PostModel.close");
/* generated: end */

#endif
