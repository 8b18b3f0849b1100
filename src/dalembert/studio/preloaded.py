"""What a process needs to answer for a study, imported before the first study is opened."""

# ruff: noqa: F401

import gc

import typer  # each process imports the program that was started

import dalembert.inverse
import dalembert.multibody.motion.sketch
import dalembert.report.charts.identification.responses
import dalembert.report.sections.motion_sections
import dalembert.studio.data.examined
import dalembert.studio.model.picture
import dalembert.studio.simulation.answers
import dalembert.study.picture
import dalembert.study.run.runner
import dalembert.study.run.validation
import dalembert.study.tables.posing

gc.collect()
gc.freeze()  # what is never looked at stays memory that the forked processes share
