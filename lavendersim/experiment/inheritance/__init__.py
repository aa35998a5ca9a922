"""Configs that extend another one: `extends: ../base.yaml`. From files to one tree and one text."""
