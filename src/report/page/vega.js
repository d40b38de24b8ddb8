// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// As much of Vega as the charts need. Its expressions are interpreted: to compile them the page
// would have to allow text to become a script (content security policy: unsafe-eval).
import {transforms} from 'vega-dataflow';
import * as encode from 'vega-encode';
import {expressionInterpreter} from 'vega-interpreter';
import {parse} from 'vega-parser';
import * as basic from 'vega-transforms';
import {View} from 'vega-view';
import * as viewTransforms from 'vega-view-transforms';

Object.assign(transforms, basic, encode, viewTransforms);

/**
 * A view of a specification.
 * @type {(spec: object, options: VegaOptions) => VegaView}
 */
export const viewOf = (spec, options) =>
    new View(parse(spec, null, {ast: true}), {...options, expr: expressionInterpreter});
