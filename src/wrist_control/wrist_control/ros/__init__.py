"""What carries messages: conversion, parameters, quality of service, diagnostics, running."""
