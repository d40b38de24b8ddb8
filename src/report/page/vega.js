// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// As much of Vega as the charts need.
import {transforms} from 'vega-dataflow';
import * as encode from 'vega-encode';
import {parse} from 'vega-parser';
import * as basic from 'vega-transforms';
import {View} from 'vega-view';
import * as viewTransforms from 'vega-view-transforms';

Object.assign(transforms, basic, encode, viewTransforms);

export {parse, View};
