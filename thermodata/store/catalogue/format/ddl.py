"""The catalogue's tables. Everything that is bulk lives in Parquet files that these rows name."""

from __future__ import annotations

FORMAT = 7  # counts the changes of tables, and of the documents that they keep (`document.KEPT`)

TABLES = """
create table store (format integer not null, created_by varchar not null, created_at timestamp not null,
                    generation bigint not null);
create table campaign (campaign varchar primary key, spec json not null, spec_hash varchar not null,
                       path varchar, ingested_at timestamp not null, data_version varchar not null);
create table machine (campaign varchar not null, test varchar not null, machine varchar not null,
                      description varchar, attributes json);
create table test (campaign varchar not null, test varchar not null, kind varchar not null, role varchar not null,
                   start_ns bigint, start timestamp_ns, duration_s double, clock varchar not null,
                   conditions json not null, pose json, tool json, phases json, window_s double[], history varchar,
                   measuring json, zero_s double, start_state varchar, repeat_of varchar, notes varchar,
                   primary key (campaign, test));
create table source (campaign varchar not null, test varchar not null, source varchar not null,
                     stream varchar not null, reader varchar not null, reader_version varchar, clock varchar not null,
                     start_ns bigint, rows bigint, step_s double, offset_ns bigint not null, complete boolean,
                     notes json);
create table channel (campaign varchar not null, test varchar not null, channel varchar not null, source varchar,
                      stream varchar, signal varchar, quantity varchar not null, unit varchar not null,
                      raw_unit varchar, axis varchar, "at" varchar, relative_to varchar, sign varchar not null,
                      calibration varchar, dtype varchar not null, sensor json, notes varchar);
create table file (campaign varchar not null, test varchar not null, source varchar not null, stream varchar not null,
                   layer varchar not null, part varchar not null, key varchar not null, path varchar not null,
                   source_path varchar, sha256 varchar, bytes bigint, rows bigint, columns json, losses json,
                   added_at timestamp not null);
create table quality_event (campaign varchar not null, test varchar not null, source varchar, channel varchar,
                            flag varchar not null, from_s double, to_s double, n bigint, detail varchar,
                            stream varchar);
create table calibration (campaign varchar not null, calibration varchar not null, kind varchar not null, axis varchar,
                          gain double, gain_unit varchar, offset_value double, sign varchar,
                          uncertainty_pct double, noise_um double, nonlinearity_pct double, drift_um double,
                          crosstalk json, checks json, detail json);
create table model (model varchar primary key, name varchar not null, parent varchar, campaigns varchar[] not null,
                    response varchar not null, spec json not null, data_version varchar not null,
                    stale boolean not null, created_at timestamp not null, result json not null);
create table fit (model varchar not null, response varchar, parameter varchar not null, value double not null,
                  unit varchar, low double, high double);
create table score_row (campaign varchar not null, test varchar not null, model varchar not null, role varchar,
                        response varchar, phase varchar, fit double, rmse_um double, ptp_um double,
                        ptp_residual_um double, max_um double, n bigint);
create table prediction (campaign varchar not null, test varchar not null, model varchar not null,
                         response varchar not null, path varchar not null, rows bigint);
create table finding (campaign varchar not null, test varchar not null, model varchar not null, kind varchar not null,
                      rank integer, payload json not null, created_at timestamp not null);
create table locked_look (campaign varchar not null, test varchar not null, model varchar not null,
                          reason varchar not null, "at" timestamp not null);
"""
# file.layer: raw | tidy. file.part: test | history (the recording before a window, for lags) | calibration.
# A raw row's source_path is relative to the campaign file; path is relative to the store. finding.kind:
# weak_spot | candidate | artefact | diagnosis | portability; campaign and test are '' where a finding has none.
